//! Marks the pixels where a check has failed.

use std::sync::Arc;

use egui::{Color32, ColorImage, Context, Id, LayerId, Order, Pos2, Rect, TextureHandle, TextureOptions, pos2};

use crate::app::state::State;
use crate::headless::CheckedPicture;

/// The color of the marks, which few pictures have.
const COLOR: Color32 = Color32::from_rgb(255, 0, 255);
/// Pixels from one stripe across a marked area to the next, and how wide one is.
const STRIPES: usize = 8;
const STRIPE: usize = 2;

/// The marks that were shown last, as a texture.
#[derive(Default)]
pub(in crate::app::panels) struct Marks(Option<(Arc<CheckedPicture>, TextureHandle)>);

/// Covers the pixels of the picture that fail.
pub(super) fn show(egui: &Context, state: &State, shown: &mut Marks, picture: Rect) {
    let checked = state.checks.of_picture().filter(|checked| checked.marks.iter().any(|mark| *mark > 0));
    let is_plain = !state.grid.is_on() && state.comparison_labels().is_none();
    let Some(checked) = checked.filter(|_| is_plain) else { return shown.0 = None };
    shown.0.take_if(|(of, _)| !Arc::ptr_eq(of, checked));
    let (_, texture) = shown.0.get_or_insert_with(|| {
        let texture = egui.load_texture("marks", image(checked), TextureOptions::NEAREST);
        (checked.clone(), texture)
    });
    let painter = egui.layer_painter(LayerId::new(Order::Background, Id::new("marks"))).with_clip_rect(picture);
    painter.image(texture.id(), picture, Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0)), Color32::WHITE);
}

/// The outlines of marked areas, and stripes across them: what they mark stays in sight. A single pixel is drawn with its neighbors.
fn image(checked: &CheckedPicture) -> ColorImage {
    let (width, height) = (checked.size.0 as usize, checked.size.1 as usize);
    let mut image = ColorImage::filled([width, height], Color32::TRANSPARENT);
    let around = |at: usize, most: usize| at.saturating_sub(1)..(at + 2).min(most);
    let is_marked = |x: usize, y: usize| checked.marks.get(y * width + x).is_some_and(|mark| *mark > 0);
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).filter(|(x, y)| is_marked(*x, *y)) {
        let near = || around(y, height).flat_map(|row| around(x, width).map(move |column| (column, row)));
        if near().any(|(column, row)| !is_marked(column, row)) {
            near().for_each(|(column, row)| image.pixels[row * width + column] = COLOR);
        } else if (x + y) % STRIPES < STRIPE {
            image.pixels[y * width + x] = COLOR;
        }
    }
    image
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_outlines_and_stripes() {
        let rows = |marks: Vec<u16>, size: (u32, u32)| -> Vec<String> {
            let image = image(&CheckedPicture { marks, size, ..CheckedPicture::default() });
            let row = |row: &[Color32]| row.iter().map(|pixel| if *pixel == COLOR { 'x' } else { '.' }).collect();
            image.pixels.chunks(size.0 as usize).map(row).collect()
        };
        let mut marks = vec![0; 20];
        marks[5] = 1;
        assert_eq!(rows(marks, (5, 4)), ["xx...", "xx...", "xx...", "....."]);
        assert_eq!(rows(vec![1; 27], (9, 3)), ["xx......x", "x......xx", "......xx."]);
    }
}
