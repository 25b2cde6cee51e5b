//! A page of HTML about the differences of pictures: all in one file, without a network.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

use image::{DynamicImage, GrayImage, ImageFormat, Luma, Rgb, RgbImage};
use serde::Serialize;
use serde_json::Value;

use super::{Comparison, Limits, Measure, Picture, differences};
use crate::report::{png_uri, uri_of};

/// The page without its pictures, and its script.
const PAGE: &str = include_str!("page.html");
const SCRIPT: &str = include_str!("page.js");

/// A picture of a pair.
#[derive(Serialize)]
struct Side {
    /// Name of its file.
    file: String,
    /// It, as a URI.
    image: String,
    /// The settings in its file as TOML, if there are any.
    settings: Option<String>,
}

/// A picture as the report takes it.
pub struct Shown<'a> {
    /// Name of its file.
    pub file: String,
    /// The bytes of its file.
    pub bytes: &'a [u8],
    /// The picture.
    pub picture: &'a Picture,
    /// The settings in its file as TOML, if there are any.
    pub settings: Option<String>,
}

/// Two pictures in the report.
#[derive(Serialize)]
pub struct ReportPair {
    name: String,
    /// Whether no limit is exceeded.
    passes: bool,
    /// Why they cannot be compared.
    why: Option<String>,
    measure: &'static str,
    /// JSON knows no infinity, and has nothing in place of it.
    error: f64,
    largest: f64,
    largest_at: Option<(u32, u32)>,
    differing: usize,
    pixels: usize,
    size: (u32, u32),
    a: Option<Side>,
    b: Option<Side>,
    /// Both values of the pixel with the largest difference: RGBA. Those that JSON does not know are text.
    worst: Option<[[Value; 4]; 2]>,
    /// [`Comparison::map`] as a URI.
    map: Option<String>,
    /// The largest difference of a channel in each pixel as a URI.
    channel: Option<String>,
    /// The settings that differ: path, and both values.
    settings: Vec<[String; 3]>,
    /// [`Comparison::badness`]; `None` if they cannot be compared.
    #[serde(skip)]
    badness: Option<[u64; 6]>,
}

impl ReportPair {
    /// Two pictures that were compared.
    ///
    /// # Errors
    /// A message if a picture cannot be encoded.
    pub fn compared(name: &str, [a, b]: [&Shown<'_>; 2], found: &Comparison, limits: Limits) -> Result<Self, String> {
        let (x, y) = found.largest_at;
        let pixels = [a, b].map(|side| side.picture.pixels());
        let index = (y * a.picture.size().0 + x) as usize;
        let worst = pixels.each_ref().map(|pixels| pixels.get(index).copied().unwrap_or_default());
        let differences = differences(&pixels[0], &pixels[1]);
        Ok(Self {
            measure: if found.measure == Measure::Flip { "FLIP" } else { "RMSE" },
            error: found.error,
            largest: found.largest,
            largest_at: Some((x, y)),
            differing: found.differing,
            pixels: found.pixels,
            worst: Some(worst.map(|values| values.map(json_of))),
            map: Some(uri_of(&displayed(found.map(), found.largest))?),
            channel: Some(uri_of(&of_channels(&differences, a.picture, found.largest))?),
            settings: settings_that_differ([a, b].map(|side| side.settings.as_deref())),
            badness: Some(found.badness(limits)),
            passes: found.passes(limits),
            why: None,
            ..Self::failed(name, [Some(a), Some(b)], String::new())?
        })
    }

    /// Pictures that cannot be compared, and why. One of them may be missing.
    ///
    /// # Errors
    /// A message if a picture cannot be encoded.
    pub fn failed(name: &str, sides: [Option<&Shown<'_>>; 2], why: String) -> Result<Self, String> {
        let size = sides.iter().flatten().next().map_or((1, 1), |side| side.picture.size());
        let [a, b] = sides.map(|side| side.map(side_of).transpose());
        Ok(Self {
            name: name.to_owned(),
            passes: false,
            why: Some(why),
            measure: "FLIP",
            error: f64::INFINITY,
            largest: f64::INFINITY,
            largest_at: None,
            differing: 0,
            pixels: 0,
            size,
            a: a?,
            b: b?,
            worst: None,
            map: None,
            channel: None,
            settings: Vec::new(),
            badness: None,
        })
    }
}

/// The page about `pairs`: those that cannot be compared, then the others, the worst first. `limits` names the limits, as in "--max 0.01".
pub fn page(title: &str, limits: &str, mut pairs: Vec<ReportPair>) -> String {
    pairs.sort_by_key(|pair| Reverse((pair.badness.is_none(), pair.badness)));
    let data = serde_json::json!({ "title": title, "limits": limits, "pairs": pairs });
    // No text of a file ends the script that holds it.
    let data = data.to_string().replace('<', "\\u003c");
    let (before, rest) = PAGE.split_once("%DATA%").unwrap_or((PAGE, ""));
    let (between, after) = rest.split_once("%SCRIPT%").unwrap_or((rest, ""));
    [before, &data, between, SCRIPT, after].concat()
}

fn side_of(shown: &Shown<'_>) -> Result<Side, String> {
    let is_png = image::guess_format(shown.bytes).is_ok_and(|format| format == ImageFormat::Png);
    let image = match (shown.picture, is_png) {
        (Picture::Display(_), true) => png_uri(shown.bytes),
        (Picture::Display(image), false) => uri_of(&image.clone().into())?,
        (Picture::Raw(image), _) => {
            let colors = image.pixels().map(|pixel| Rgb([0, 1, 2].map(|channel| srgb(pixel.0[channel]))));
            uri_of(&pixels_to_image(colors, image.dimensions()).into())?
        }
    };
    Ok(Side { file: shown.file.clone(), image, settings: shown.settings.clone() })
}

fn pixels_to_image(pixels: impl Iterator<Item = Rgb<u8>>, (width, height): (u32, u32)) -> RgbImage {
    let mut image = RgbImage::new(width, height);
    image.pixels_mut().zip(pixels).for_each(|(to, from)| *to = from);
    image
}

/// Linear light as 8 bits of sRGB.
fn srgb(linear: f32) -> u8 {
    let linear = if linear.is_nan() { 0.0 } else { linear.clamp(0.0, 1.0) };
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

/// A number, or the name of one that JSON does not know.
fn json_of(value: f32) -> Value {
    if value.is_finite() { value.into() } else { value.to_string().into() }
}

/// A map in 8 bits: that of raw values with the largest difference as white.
fn displayed(map: &DynamicImage, largest: f64) -> DynamicImage {
    let DynamicImage::ImageRgb32F(floats) = map else { return map.clone() };
    let colors = floats.pixels().map(|pixel| Rgb(pixel.0.map(|value| part(value, largest))));
    pixels_to_image(colors, floats.dimensions()).into()
}

/// The largest difference of a channel in each pixel: in steps of 8 bits, or with the largest of raw values as white.
fn of_channels(differences: &[[f32; 4]], picture: &Picture, largest: f64) -> DynamicImage {
    let white = if matches!(picture, Picture::Display(_)) { 1.0 } else { largest };
    let most = |pixel: &[f32; 4]| pixel.iter().fold(0.0_f32, |most, value| most.max(value.abs()));
    let (width, height) = picture.size();
    let mut image = GrayImage::new(width, height);
    image.pixels_mut().zip(differences).for_each(|(to, from)| *to = Luma([part(most(from), white)]));
    image.into()
}

/// A difference in 8 bits, of which `white` is the largest. What is not finite is white.
fn part(value: f32, white: f64) -> u8 {
    if !value.is_finite() {
        return 255;
    }
    let finite = if white.is_finite() && white > 0.0 { white } else { 1.0 };
    (f64::from(value) / finite * 255.0).round().clamp(0.0, 255.0) as u8
}

/// The settings that differ between two texts: path, and both values.
fn settings_that_differ(texts: [Option<&str>; 2]) -> Vec<[String; 3]> {
    let parsed = texts.map(|text| text.and_then(|text| toml::from_str::<toml::Table>(text).ok()));
    let [Some(a), Some(b)] = parsed else { return Vec::new() };
    let [mut a, mut b] = [a, b].map(|table| {
        let mut all = BTreeMap::new();
        flatten("", &toml::Value::Table(table), &mut all);
        all
    });
    let paths: BTreeSet<String> = a.keys().chain(b.keys()).cloned().collect();
    let rows = paths.into_iter().map(|path| {
        let values = [&mut a, &mut b].map(|side| side.remove(&path).unwrap_or_default());
        let [of_a, of_b] = values;
        [path, of_a, of_b]
    });
    rows.filter(|[_, a, b]| a != b).collect()
}

fn flatten(path: &str, value: &toml::Value, all: &mut BTreeMap<String, String>) {
    let below = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    match value {
        toml::Value::Table(table) => table.iter().for_each(|(name, value)| flatten(&below(name), value, all)),
        toml::Value::Array(list) if list.iter().any(toml::Value::is_table) => {
            list.iter().enumerate().for_each(|(index, value)| flatten(&below(&index.to_string()), value, all));
        }
        other => drop(all.insert(path.to_owned(), other.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use base64::Engine as _;
    use base64::prelude::BASE64_STANDARD;
    use image::{Rgba, RgbaImage};

    use super::*;

    #[test]
    fn the_page_has_all_it_shows_and_the_worst_first() {
        let flat = |value| Picture::Display(RgbaImage::from_pixel(4, 4, Rgba([value, 0, 0, 255])));
        let shown = |picture, settings: &str| Shown {
            file: "</script><b>.png".into(),
            bytes: &[],
            picture,
            settings: Some(settings.to_owned()),
        };
        let (black, red) = (flat(0), flat(200));
        let [a, b] = [shown(&black, "mode = \"d\"\n[view]\nev = 1.0"), shown(&red, "mode = \"d\"\n[view]\nev = 2.0")];
        let pair = |name, sides: [&Shown<'_>; 2]| {
            let found = Comparison::new(sides[0].picture, sides[1].picture).unwrap();
            ReportPair::compared(name, sides, &found, Limits::default()).unwrap()
        };
        let lone = ReportPair::failed("lone", [Some(&a), None], "only in a".into()).unwrap();
        let page = page("a and b", "--max 0", vec![pair("same", [&a, &a]), pair("differs", [&a, &b]), lone]);
        assert!(!page.contains("://"), "it names a place in the network");
        let data = page.split("id=\"data\">").nth(1).unwrap().split("</script>").next().unwrap();
        let data: serde_json::Value = serde_json::from_str(data).unwrap();
        let pairs = data["pairs"].as_array().unwrap();
        let names: Vec<_> = pairs.iter().map(|pair| pair["name"].as_str().unwrap()).collect();
        assert_eq!(names, ["lone", "differs", "same"]);
        let differs = &pairs[1];
        assert_eq!(differs["settings"], serde_json::json!([["view.ev", "1.0", "2.0"]]));
        assert_eq!((differs["passes"].as_bool(), pairs[2]["passes"].as_bool()), (Some(false), Some(true)));
        assert!((differs["worst"][1][0].as_f64().unwrap() - 200.0 / 255.0).abs() < 1e-6);
        let decode = |uri: &serde_json::Value| {
            let base64 = uri.as_str().unwrap().strip_prefix("data:image/png;base64,").unwrap();
            image::load_from_memory(&BASE64_STANDARD.decode(base64).unwrap()).unwrap()
        };
        assert_eq!(decode(&differs["channel"]).to_luma8().get_pixel(0, 0).0, [200]);
        assert_eq!(decode(&differs["b"]["image"]).to_rgba8().get_pixel(3, 3).0, [200, 0, 0, 255]);
        assert_eq!(decode(&differs["map"]).to_rgb8().dimensions(), (4, 4));
    }

    #[test]
    fn maps_of_raw_values_reach_from_equal_to_the_largest() {
        assert_eq!([0.0, 1.0, 2.0, f32::INFINITY, f32::NAN].map(|value| part(value, 2.0)), [0, 128, 255, 255, 255]);
        assert_eq!([part(0.5, f64::INFINITY), part(0.0, 0.0)], [128, 0]);
    }
}
