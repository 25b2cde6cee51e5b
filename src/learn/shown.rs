//! Goals that a picture is rendered for, most of them beside the picture of the solution.

use super::measured::{Verdict, number, with_expected};
use crate::render::Capture;

/// Compares the raw values of a mode. A value may differ by `within` times itself, or times `scale` if that is larger.
pub(super) fn values(found: &Capture, solved: &Capture, name: &str, within: f64, scale: f64) -> Verdict {
    let mut worst = (0.0_f64, 0, 0);
    let mut covered = 0;
    for (index, (f, s)) in found.raw.iter().zip(&solved.raw).enumerate() {
        // Where the model does not cover a pixel, there is no value.
        if s[3] < 1.0 || solved.no_data[index] {
            continue;
        }
        covered += 1;
        for channel in 0..3 {
            let (f, s) = (f64::from(f[channel]), f64::from(s[channel]));
            let is_missing = found.no_data[index] || found.not_finite[index];
            let error = if is_missing { f64::INFINITY } else { (f - s).abs() / s.abs().max(scale) };
            let error = if error.is_nan() { f64::INFINITY } else { error };
            if error > worst.0 {
                worst = (error, index, channel);
            }
        }
    }
    let (error, index, channel) = worst;
    let is_good = covered > 0 && error <= within;
    if is_good {
        return (true, format!("{name} is right in all of {covered} pixels"));
    }
    let (f, s) = (f64::from(found.raw[index][channel]), f64::from(solved.raw[index][channel]));
    let f = if found.no_data[index] { "nothing".to_owned() } else { number(f) };
    (false, format!("{name} is {f} {}; {} was expected", place(found, index), number(s)))
}

/// Compares displayed pictures.
pub(super) fn pictures(found: &Capture, solved: &Capture, within: u8) -> Verdict {
    let pairs = found.rgba8.iter().zip(&solved.rgba8).enumerate();
    let worst = pairs.map(|(index, (f, s))| (f.abs_diff(*s), index)).max_by_key(|(difference, _)| *difference);
    let Some((difference, index)) = worst else { return (false, "nothing was drawn".to_owned()) };
    if difference <= within {
        return (true, format!("the picture is right to {difference} of 255"));
    }
    let channel = ["red", "green", "blue", "alpha"][index % 4];
    let (f, s) = (found.rgba8[index], solved.rgba8[index]);
    (false, format!("{channel} is {f} of 255 {}; {s} was expected", place(found, index / 4)))
}

/// Looks for pixels that are NaN or infinite.
pub(super) fn finite(found: &Capture) -> Verdict {
    let is_bad = |(raw, flag): (&[f32; 4], &bool)| *flag || raw.iter().any(|channel| !channel.is_finite());
    let all = found.raw.iter().zip(&found.not_finite);
    let count = all.clone().filter(|pair| is_bad(*pair)).count();
    match all.enumerate().find(|(_, pair)| is_bad(*pair)) {
        None => (true, "every pixel is a finite number".to_owned()),
        Some((index, _)) => {
            let percent = 100.0 * count as f64 / found.raw.len().max(1) as f64;
            let says =
                format!("{count} pixels ({percent:.0} %) are NaN or infinite, the first {}", place(found, index));
            (false, format!("{says}; none was expected"))
        }
    }
}

/// By which factor a pass changes the light of a pixel. `without`: the frame without the pass.
pub(super) fn light(with: &Capture, without: &Capture, at: (f32, f32), factor: f64, within: f64) -> Verdict {
    let pixel = |part: f32, size: u32| ((part * size as f32) as u32).min(size.saturating_sub(1));
    let (x, y) = (pixel(at.0, with.width), pixel(at.1, with.height));
    let sum = |capture: &Capture| capture.raw_at(x, y).map_or(0.0, |raw| f64::from(raw[0] + raw[1] + raw[2]));
    let found = sum(with) / sum(without);
    let is_good = (found - factor).abs() <= within;
    let where_it_is = match at {
        (0.5, 0.5) => "the middle",
        (x, y) if x.min(1.0 - x) + y.min(1.0 - y) < 0.1 => "the corner",
        _ => "the pixel",
    };
    let says = format!("{where_it_is} of the picture keeps {} of its light", number(found));
    (is_good, with_expected(says, is_good, factor))
}

/// The position of a pixel.
fn place(capture: &Capture, index: usize) -> String {
    let (x, y) = (index as u32 % capture.width.max(1), index as u32 / capture.width.max(1));
    let percent = |at: u32, size: u32| 100 * at / size.max(1);
    format!(
        "at {} % from the left and {} % from the top of the picture",
        percent(x, capture.width),
        percent(y, capture.height)
    )
}
