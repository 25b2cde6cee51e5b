//! The value under the mouse, in words.

use crate::app::readings::Readout;
use crate::app::screen::PixelUnderMouse;
use crate::render::PixelAt;
use crate::shader::{Mode, PixelValue};

/// The value of a pixel; `None` where nothing covers the pixel. `sides`: the names of both sides of a comparison.
pub(super) fn readout(pixel: &PixelUnderMouse<'_>, sides: Option<[String; 2]>) -> Option<Readout> {
    let PixelAt { at, value, .. } = &pixel.pixel;
    let covered = value.value[3] > 0.0 || value.no_data || value.not_finite;
    // Alpha of a pass is a number as the others.
    let mode = pixel.state.mode().filter(|mode| covered || mode.pass.is_some())?;
    let [value, unit] = texts(mode, value, pixel.exact);
    let side = sides.map(|[earlier, now]| if pixel.is_of_reference { earlier } else { now });
    Some(Readout { side, value: value.trim_start().to_owned(), unit, at: *at })
}

/// A pixel's value and its unit: see [`readout`].
fn texts(mode: &Mode, picture: &PixelValue, exact: Option<Option<PixelValue>>) -> [String; 2] {
    match exact {
        Some(Some(number)) if mode.numbers.is_some() => [number.text(mode).trim().to_owned(), String::new()],
        Some(None) if mode.numbers.is_some() => ["…".to_owned(), String::new()],
        // At an edge, the pixel is an average of several surfaces.
        Some(Some(exact)) if picture.value[3] >= 1.0 && exact.value[3] >= 1.0 => exact.parts_in_picture(mode),
        _ => picture.parts_in_picture(mode),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::{Encode, Numbers};

    #[test]
    fn the_exact_value_replaces_that_of_the_picture_except_at_edges() {
        let value = |number: f32, coverage| PixelValue { value: [number, 0.0, 0.0, coverage], ..PixelValue::default() };
        let mode = Mode { components: 1, encode: Encode::Data, ..Mode::default() };
        let text = |mode: &Mode, picture: PixelValue, exact| texts(mode, &picture, exact)[0].trim().to_owned();
        let half = value(3.183_594, 1.0);
        let exact = Some(Some(value(3.183_1, 1.0)));
        assert_eq!(text(&mode, half, None), "3.18359");
        assert_eq!(text(&mode, half, Some(None)), "3.18359");
        assert_eq!(text(&mode, half, exact), "3.18310");
        assert_eq!(text(&mode, value(1.5, 0.5), exact), "1.50000");
        assert_eq!(text(&mode, half, Some(Some(value(0.0, 0.0)))), "3.18359");

        let colors = Mode { numbers: Some(Numbers::Index), ..mode };
        assert_eq!(text(&colors, half, Some(None)), "…");
        assert_eq!(text(&colors, half, Some(Some(value(7.0, 1.0)))), "7");
    }
}
