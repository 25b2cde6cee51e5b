//! Parsers of option values. Each error says what was expected, with an example or a range.

use specula::settings::Valid;

use crate::commands::Failure;

/// Three finite numbers, as `0,1.5,3`.
pub fn vector(text: &str) -> Result<[f32; 3], String> {
    let numbers: Option<Vec<f32>> = text.split(',').map(|t| t.trim().parse().ok()).collect();
    let vector = numbers.and_then(|numbers| <[f32; 3]>::try_from(numbers).ok());
    let vector = vector.ok_or_else(|| "expected three numbers, as 0,1.5,3".to_owned())?;
    if vector.iter().all(|v| v.is_finite()) { Ok(vector) } else { Err("expected three finite numbers".into()) }
}

/// A width and a height in pixels, as `1280x720`.
pub fn size(text: &str) -> Result<(u32, u32), String> {
    let parts = text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    match parts {
        Some((width, height)) if width > 0 && height > 0 => Ok((width, height)),
        _ => Err("expected WIDTHxHEIGHT in pixels, each at least 1, as 1280x720".into()),
    }
}

/// A vertical field of view, degrees.
pub fn fovy(text: &str) -> Result<f32, String> {
    setting("camera.fovy", " degrees", text)
}

/// An exposure value, EV100.
pub fn ev(text: &str) -> Result<f32, String> {
    setting("view.ev", "", text)
}

/// A number from `low` to `high`.
pub fn number(text: &str, low: f32, high: f32) -> Result<f32, String> {
    let number = text.trim().parse::<f32>().ok().filter(|number| (low..=high).contains(number));
    number.ok_or_else(|| format!("expected a number, {low} to {high}"))
}

/// A number within the limits of a setting.
fn setting(path: &str, unit: &str, text: &str) -> Result<f32, String> {
    let valid = specula::settings::setting(path).map_or(Valid::Any, |setting| setting.entry.valid);
    let is_valid = |number: &f32| matches!(valid, Valid::Limits(low, high) if (low..=high).contains(number));
    let number = text.trim().parse::<f32>().ok().filter(is_valid);
    number.ok_or_else(|| format!("expected a number, {}{unit}", valid.text()))
}

/// A pixel, counted from the upper left corner.
pub fn pixel(text: &str) -> Result<(u32, u32), String> {
    let numbers = text.split_once(',').and_then(|(x, y)| Some((x.trim().parse().ok()?, y.trim().parse().ok()?)));
    numbers.ok_or_else(|| "expected a pixel as X,Y, counted from the upper left corner, for example 640,360".to_owned())
}

/// Checks that a picture of this width and height has the pixel of `--at`.
///
/// # Errors
/// It has not.
pub fn inside((x, y): (u32, u32), (width, height): (u32, u32)) -> Result<(), Failure> {
    if x < width && y < height {
        return Ok(());
    }
    let last = format!("{},{}", width - 1, height - 1);
    Err(Failure::Usage(format!("--at {x},{y} is outside of the picture ({width}x{height}); it can be 0,0 to {last}")))
}
