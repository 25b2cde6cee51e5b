//! The values of a pixel as text: numbers of a row, a table and JSON to copy.

use serde_json::{Map, Value, json};

use super::Reading;
use crate::render::Texel;
use crate::shader::not_finite::NotFinite;
use crate::shader::{Encode, Mode, PixelValue};

/// The numbers of a mode in a row of the panel, with five significant digits; or why there are none.
pub(in crate::app) fn numbers(mode: &Mode, value: &PixelValue) -> String {
    match value {
        PixelValue { not_finite: true, .. } => "NaN or Inf".into(),
        PixelValue { no_data: true, .. } => "no data".into(),
        PixelValue { .. } if mode.numbers.is_some() => value.text(mode).trim().to_owned(),
        PixelValue { value, .. } => {
            let count = usize::from(mode.components).clamp(1, 3);
            value[..count].iter().map(|number| format!("{:>7}", short(*number))).collect::<Vec<_>>().join(" ")
        }
    }
}

/// A number in at most eight characters.
fn short(number: f32) -> String {
    let magnitude = number.abs();
    if magnitude != 0.0 && !(1e-3..1e5).contains(&magnitude) {
        return format!("{number:.1e}");
    }
    let digits_before = magnitude.max(1.0).log10() as usize;
    format!("{number:.0$}", 4_usize.saturating_sub(digits_before))
}

/// The color of a swatch, 0..1 before the sRGB curve. `exposure` applies to modes that the tone map shows.
pub(in crate::app) fn swatch(mode: &Mode, value: &PixelValue, exposure: f32) -> [f32; 3] {
    let [r, g, b, _] = value.value;
    let rgb = if mode.components == 1 { [r; 3] } else { [r, g, b] };
    match mode.encode {
        // The swatch gets the curve that these have already.
        Encode::Color if mode.is_displayed => rgb.map(|number| number.clamp(0.0, 1.0).powf(2.2)),
        Encode::Color if mode.tonemap => rgb.map(|number| {
            let exposed = (number * exposure).max(0.0);
            exposed / (1.0 + exposed)
        }),
        Encode::Color | Encode::Data => rgb.map(|number| number.clamp(0.0, 1.0)),
        Encode::Vector => rgb.map(|number| (0.5 * number + 0.5).clamp(0.0, 1.0)),
    }
}

/// All values in JSON, in the form of `specula probe`.
pub(in crate::app) fn json(reading: &Reading, modes: &[Mode], not_finite: Option<&NotFinite>) -> Value {
    let values: Map<String, Value> = reading.json(modes).collect();
    let camera = &reading.camera;
    let names = reading.names.as_ref();
    let mut out = json!({
        "pixel": reading.at,
        "hit": reading.is_hit(),
        "node": names.map(|[node, _]| node),
        "material": names.map(|[_, material]| material),
        "modes": values,
        "camera": { "eye": camera.eye.to_array(), "target": camera.target.to_array(), "fovy": camera.fovy_rad.to_degrees() },
        "textures": reading.texels.iter().map(Texel::json).collect::<Vec<_>>(),
    });
    if let Some(found) = not_finite {
        out["not_finite"] = found.json();
    }
    out
}

/// All values as a table, in the order and groups of `modes`.
pub(in crate::app) fn table(reading: &Reading, modes: &[Mode], not_finite: Option<&NotFinite>) -> String {
    let [x, y] = reading.at;
    let mut lines = vec![format!("pixel {x} {y}")];
    if let Some([node, material]) = &reading.names {
        lines.push(format!("node {node}, material {material}"));
    }
    let read = || modes.iter().filter_map(|mode| Some((mode, reading.value(&mode.slug)?)));
    let width = read().map(|(mode, _)| mode.slug.len()).max().unwrap_or(0);
    let mut group = "";
    for (mode, value) in read() {
        if mode.group != group {
            lines.push(format!("\n{}", mode.group));
            group = &mode.group;
        }
        lines.push(format!("  {:width$}  {}", mode.slug, value.text(mode).trim_end()));
    }
    if !reading.texels.is_empty() {
        lines.push("\nTextures".to_owned());
    }
    lines.extend(reading.texels.iter().map(|texel| format!("  {}  {}", texel.place.slot_name(), texel.text())));
    lines.extend(not_finite.map(|found| format!("\n{}", found.text())));
    lines.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(slug: &str, group: &str, components: u8, unit: &str) -> Mode {
        let [slug, group, unit] = [slug, group, unit].map(str::to_owned);
        Mode { slug, group, components, unit, encode: Encode::Data, ..Mode::default() }
    }

    fn value(numbers: [f32; 3]) -> PixelValue {
        let [r, g, b] = numbers;
        PixelValue { value: [r, g, b, 1.0], ..PixelValue::default() }
    }

    fn reading() -> Reading {
        let values = [
            ("depth", value([2.5; 3])),
            ("position", value([1.0, -2.0, 0.5])),
            ("d", PixelValue { not_finite: true, ..value([0.0; 3]) }),
            ("uv1", PixelValue { no_data: true, ..value([0.0; 3]) }),
        ];
        let values = values.into_iter().map(|(slug, value)| (slug.to_owned(), (value, 1)));
        let names = Some(["ball".into(), "gold".into()]);
        Reading { at: [12, 34], names, ..Reading::sample(values.collect()) }
    }

    #[test]
    fn numbers_of_a_row_keep_five_digits_and_at_most_eight_characters() {
        let three = mode("position", "", 3, "m");
        assert_eq!(numbers(&three, &value([0.123_456, -12.345_67, 1234.567])), " 0.1235 -12.346  1234.6");
        let one = mode("d", "", 1, "1/sr");
        for (number, text) in [(0.0, "  0.0000"), (1e-5, "  1.0e-5"), (99_999.0, "   99999"), (-3.4e38, "-3.4e38")] {
            assert_eq!(numbers(&one, &value([number; 3])).trim_start(), text.trim_start());
        }
        assert_eq!(numbers(&one, &PixelValue { not_finite: true, ..PixelValue::default() }), "NaN or Inf");
    }

    #[test]
    fn json_is_that_of_probe() {
        let modes = ["depth", "position", "d", "uv1"].map(|slug| mode(slug, "", 3, ""));
        let found = json(&reading(), &modes, None);
        assert_eq!(found["pixel"], json!([12, 34]));
        assert_eq!(found["modes"]["position"], json!([1.0, -2.0, 0.5, 1.0]));
        assert_eq!((&found["modes"]["d"], &found["modes"]["uv1"]), (&json!("NaN"), &Value::Null));
        assert_eq!((&found["hit"], &found["material"]), (&json!(true), &json!("gold")));
    }

    #[test]
    fn the_table_has_groups_and_units() {
        let modes =
            [mode("position", "Geometry", 3, "m"), mode("depth", "Geometry", 1, "m"), mode("d", "BRDF", 1, "1/sr")];
        let table = table(&reading(), &modes, None);
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!(
            (lines[0], lines[1], lines[3], lines[7]),
            ("pixel 12 34", "node ball, material gold", "Geometry", "BRDF")
        );
        assert!(lines[5].ends_with("2.50000 m") && lines[8].ends_with("NaN"), "{table}");
    }

    #[test]
    fn swatches_show_vectors_and_exposed_light() {
        let vector = Mode { encode: Encode::Vector, components: 3, ..Mode::default() };
        assert_eq!(swatch(&vector, &value([-1.0, 0.0, 1.0]), 1.0), [0.0, 0.5, 1.0]);
        let light = Mode { encode: Encode::Color, components: 3, tonemap: true, ..Mode::default() };
        assert_eq!(swatch(&light, &value([2.0, 0.0, -1.0]), 0.5), [0.5, 0.0, 0.0]);
        let scalar = mode("roughness", "", 1, "");
        assert_eq!(swatch(&scalar, &value([0.25, 0.0, 0.0]), 1.0), [0.25; 3]);
    }
}
