//! Text on an image, in the font of the window.

use ab_glyph::{Font as _, FontVec, PxScale, ScaleFont as _, point};
use image::{Rgba, RgbaImage};

/// Writes text.
pub(super) struct Labels(FontVec);

impl Labels {
    /// Loads the font.
    ///
    /// # Errors
    /// This build has none.
    pub(super) fn new() -> Result<Self, String> {
        let fonts = egui::FontDefinitions::default().font_data;
        let data = fonts.get("Ubuntu-Light").or_else(|| fonts.values().next()).ok_or("this build has no font")?;
        FontVec::try_from_vec(data.font.to_vec()).map(Self).map_err(|error| error.to_string())
    }

    /// The width of a line that is `size` pixels high.
    pub(super) fn width(&self, size: f32, text: &str) -> f32 {
        let font = self.0.as_scaled(PxScale::from(size));
        text.chars().map(|character| font.h_advance(font.glyph_id(character))).sum()
    }

    /// The text, or its beginning and its end around an ellipsis: it is often the ends that differ.
    fn fitting(&self, size: f32, text: &str, width: f32) -> String {
        if self.width(size, text) <= width {
            return text.to_owned();
        }
        let letters: Vec<char> = text.chars().collect();
        let cut = |kept: usize| -> String {
            let (begin, end) = (kept.div_ceil(2), letters.len() - kept / 2);
            letters[..begin].iter().chain(&['…']).chain(&letters[end..]).collect()
        };
        (0..letters.len()).rev().map(cut).find(|text| self.width(size, text) <= width).unwrap_or_default()
    }

    /// Writes a line whose upper left corner is at `at`, `size` pixels high. What does not fit in `width` has an ellipsis in its
    /// middle. Returns the width.
    pub(super) fn write(
        &self,
        image: &mut RgbaImage,
        at: (u32, u32),
        (size, width): (f32, f32),
        color: [u8; 3],
        text: &str,
    ) -> f32 {
        let font = self.0.as_scaled(PxScale::from(size));
        let mut x = 0.0;
        let mut glyphs = Vec::new();
        for character in self.fitting(size, text, width).chars() {
            let id = font.glyph_id(character);
            glyphs.push((id, x));
            x += font.h_advance(id);
        }
        for (id, x) in glyphs {
            let position = point(at.0 as f32 + x, at.1 as f32 + font.ascent());
            let Some(outline) = self.0.outline_glyph(id.with_scale_and_position(size, position)) else { continue };
            let corner = outline.px_bounds().min;
            outline.draw(|dx, dy, coverage| {
                let (x, y) = (corner.x + dx as f32, corner.y + dy as f32);
                let inside = x >= 0.0 && y >= 0.0 && x < image.width() as f32 && y < image.height() as f32;
                if inside {
                    let pixel = image.get_pixel_mut(x as u32, y as u32);
                    blend(pixel, color, coverage.clamp(0.0, 1.0));
                }
            });
        }
        x
    }
}

fn blend(pixel: &mut Rgba<u8>, color: [u8; 3], coverage: f32) {
    for (channel, color) in pixel.0.iter_mut().zip(color) {
        *channel = (f32::from(*channel) + (f32::from(color) - f32::from(*channel)) * coverage).round() as u8;
    }
    pixel.0[3] = pixel.0[3].max((coverage * 255.0) as u8);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_that_does_not_fit_is_cut() {
        let labels = Labels::new().unwrap();
        let mut image = RgbaImage::new(200, 20);
        let short = labels.write(&mut image, (0, 0), (14.0, 200.0), [255; 3], "D");
        assert!(short > 4.0 && short < 20.0);
        assert!(image.pixels().any(|pixel| pixel[0] > 200));
        let cut = labels.write(&mut image, (0, 0), (14.0, 60.0), [255; 3], "Normal distribution D");
        assert!(cut <= 60.0 && cut > 30.0, "{cut}");
        assert!(labels.width(14.0, "Normal distribution D") > 60.0 && (labels.width(14.0, "D") - short).abs() < 0.01);
    }
}
