//! State that the mode gallery and the screen share: the visible thumbnails, their places in the texture, and the hovered mode.

use std::collections::{BTreeSet, HashMap};
use std::time::Duration;

/// How long the mouse must rest on a mode before the picture previews it.
const REST: Duration = Duration::from_millis(300);

/// The gallery's state in the panel of modes.
pub(super) struct GalleryState {
    /// Whether the modes are shown as thumbnails; else as a list.
    pub(super) is_on: bool,
    /// Slugs of the modes whose thumbnails are in sight in this frame.
    pub(super) visible: BTreeSet<String>,
    /// Width and height of a thumbnail, points.
    pub(super) size: egui::Vec2,
    /// The texture with all thumbnails.
    pub(super) texture: Option<egui::TextureId>,
    /// Where the thumbnail of a mode is in the texture, from 0 to 1.
    pub(super) places: HashMap<String, egui::Rect>,
    /// The mode under the mouse in this frame.
    hovered: Option<String>,
    /// The mode that the picture previews while the mouse rests on it.
    preview: Option<String>,
}

impl Default for GalleryState {
    fn default() -> Self {
        Self {
            is_on: true,
            visible: BTreeSet::new(),
            size: egui::Vec2::ZERO,
            texture: None,
            places: HashMap::new(),
            hovered: None,
            preview: None,
        }
    }
}

impl GalleryState {
    /// Forgets the visible thumbnails of the previous frame.
    pub(super) fn begin_frame(&mut self) {
        self.visible.clear();
        self.hovered = None;
    }

    /// Records that the mouse is on a mode.
    pub(super) fn hover(&mut self, slug: &str) {
        self.hovered = Some(slug.to_owned());
    }

    /// Decides which mode the picture previews: the one on which the mouse has rested.
    pub(super) fn end_frame(&mut self, egui: &egui::Context) {
        let Some(hovered) = self.hovered.take() else {
            self.preview = None;
            return;
        };
        let rested = egui.input(|input| input.pointer.time_since_last_movement());
        let left = REST.as_secs_f32() - rested;
        let is_held = egui.input(|input| input.pointer.any_down());
        if left <= 0.0 && !is_held {
            self.preview = Some(hovered);
        } else if self.preview.as_ref() != Some(&hovered) {
            egui.request_repaint_after(Duration::from_secs_f32(left.max(0.01)));
        }
    }

    /// The mode that the picture previews instead of the selected one.
    pub(super) fn preview(&self) -> Option<&str> {
        self.preview.as_deref()
    }
}
