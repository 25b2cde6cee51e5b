//! The thumbnails of modes as the panels show them, and the mode that the mouse rests on.

use std::collections::HashMap;
use std::time::Duration;

use egui::Vec2;

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
pub(super) struct Preview {
    shown: Option<String>,
    /// The mode under the mouse in the last frame.
    under: Option<String>,
    /// Whether it came under a mouse that rested, as behind a menu that has closed.
    is_unasked: bool,
}

impl Preview {
    /// Takes the mode under the mouse in this frame. Returns the mode that the picture previews.
    pub(super) fn follow(&mut self, egui: &egui::Context, hovered: Option<String>) -> Option<String> {
        let moves =
            egui.input(|input| input.pointer.delta() != Vec2::ZERO || input.smooth_scroll_delta() != Vec2::ZERO);
        if hovered != self.under {
            self.is_unasked = !moves;
            self.under.clone_from(&hovered);
        } else if moves {
            self.is_unasked = false;
        }
        let Some(hovered) = hovered.filter(|_| !self.is_unasked) else {
            self.shown = None;
            return None;
        };
        let rested = egui.input(|input| input.pointer.time_since_last_movement());
        let left = REST.as_secs_f32() - rested;
        let is_held = egui.input(|input| input.pointer.any_down());
        if left <= 0.0 && !is_held {
            self.shown = Some(hovered);
        } else if self.shown.as_ref() != Some(&hovered) {
            egui.request_repaint_after(Duration::from_secs_f32(left.max(0.01)));
        }
        self.shown.clone()
    }
}

#[cfg(test)]
mod tests {
    use egui::{Context, Event, RawInput, pos2};

    use super::*;

    #[test]
    fn a_mode_that_comes_under_a_resting_mouse_is_not_previewed() {
        let egui = Context::default();
        let mut preview = Preview::default();
        let mut time = 0.0;
        let mut frame = |moves_to: Option<f32>, hovered: Option<&str>| {
            time += 1.0;
            let events = moves_to.map(|x| Event::PointerMoved(pos2(x, 5.0))).into_iter().collect();
            let mut shown = None;
            let input = RawInput { time: Some(time), events, ..RawInput::default() };
            let _ = egui.run_ui(input, |ui| shown = preview.follow(ui.ctx(), hovered.map(str::to_owned)));
            shown
        };
        frame(Some(1.0), None);
        frame(Some(5.0), None);
        // A menu over the mode closes.
        assert_eq!(frame(None, Some("clay")), None);
        assert_eq!(frame(None, Some("clay")), None);
        // The mouse moves on the mode, and rests.
        frame(Some(6.0), Some("clay"));
        assert_eq!(frame(None, Some("clay")).as_deref(), Some("clay"));
        assert_eq!(frame(Some(50.0), None), None);
        frame(Some(60.0), Some("depth"));
        assert_eq!(frame(None, Some("depth")).as_deref(), Some("depth"));
    }
}
