//! The thumbnails of modes as the panels show them, and the mode that the mouse rests on.

use std::collections::HashMap;
use std::time::Duration;

/// How long the mouse must rest on a mode before the picture previews it.
const REST: Duration = Duration::from_millis(300);

/// The texture with all thumbnails.
#[derive(Default)]
pub(super) struct Thumbnails {
    pub(super) texture: Option<egui::TextureId>,
    /// Where the thumbnail of a mode is in the texture, from 0 to 1.
    pub(super) places: HashMap<String, egui::Rect>,
}

/// Decides which mode the picture previews: the one on which the mouse has rested.
#[derive(Default)]
pub(super) struct Preview(Option<String>);

impl Preview {
    /// Takes the mode under the mouse in this frame. Returns the mode that the picture previews.
    pub(super) fn follow(&mut self, egui: &egui::Context, hovered: Option<String>) -> Option<String> {
        let Some(hovered) = hovered else {
            self.0 = None;
            return None;
        };
        let rested = egui.input(|input| input.pointer.time_since_last_movement());
        let left = REST.as_secs_f32() - rested;
        let is_held = egui.input(|input| input.pointer.any_down());
        if left <= 0.0 && !is_held {
            self.0 = Some(hovered);
        } else if self.0.as_ref() != Some(&hovered) {
            egui.request_repaint_after(Duration::from_secs_f32(left.max(0.01)));
        }
        self.0.clone()
    }
}
