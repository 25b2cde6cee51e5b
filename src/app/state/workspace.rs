//! Requests to panels for the next frame, and the panels that the last frame has shown.

use std::collections::BTreeSet;

use super::arrangement::{Panel, Preset};
use super::dialog::Dialog;
use crate::recovery::TypedText;
use crate::render::tools::{TextureView, UvMesh};
use crate::scene::TextureSource;
use crate::shader::TreePath;

/// A change of the user interface that something else than the user interface asks for.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::app) enum PanelRequest {
    /// Hide or show all panels.
    Toggle,
    /// Show the panels if they are hidden.
    Unhide,
    /// Open a panel, or show its tab.
    Open(Panel),
    /// Show an arrangement.
    Arrange(Preset),
    /// Show an arrangement until [`Self::ArrangeAsBefore`]. The next window is arranged as before.
    ArrangeTemporarily(Preset),
    /// Show the arrangement before the temporary one.
    ArrangeAsBefore,
    /// Show the user's own arrangement.
    ArrangeOwn,
    /// Show the chosen arrangement without the user's changes.
    ResetArrangement,
    /// Show the exercise, if its panel is not in sight.
    ShowExercise,
    /// Change between the light and the dark theme.
    ToggleTheme,
    /// Show or hide the histogram of the picture's values.
    ToggleHistogram,
    /// Show or hide the list of keys.
    ToggleKeys,
    /// Open or close the command palette.
    TogglePalette,
    /// Open the command palette with the files of the working directory, in place of a dialog that the desktop lacks.
    ChooseFile(Option<Dialog>),
    /// Show what can be opened, with pictures.
    ShowGallery,
    /// Ask whether to write this version to the files.
    AskVersion(u64),
    /// Ask whether to write the values of the parameters to the files.
    AskDefaults,
    /// Give the keys to the field of the panel Expression.
    FocusExpression,
    /// Scroll the list of the scene to the selection.
    FollowSelection,
    /// Go on with texts that were typed and not saved in a window before this one.
    RestoreTyped(Vec<TypedText>),
}

/// A picture of a texture that the panel Texture shows.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::app) struct TextureRequest {
    pub(in crate::app) source: TextureSource,
    pub(in crate::app) view: TextureView,
    pub(in crate::app) meshes: Vec<UvMesh>,
    /// Pixels.
    pub(in crate::app) size: (u32, u32),
}

/// The panels and rows that the last frame has shown. Values that nobody sees are neither drawn nor measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::app) struct Sight {
    /// Whether the panel with the exercise was in sight.
    pub(in crate::app) learn: bool,
    /// Whether the versions of the shaders were.
    pub(in crate::app) timeline: bool,
    /// Whether the times of frames were.
    pub(in crate::app) timing: bool,
    /// Whether the values of the inspected pixel were.
    pub(in crate::app) inspector: bool,
    /// Whether the code with the values of the pinned pixel was.
    pub(in crate::app) source: bool,
    /// The file whose evaluations at the pinned pixel were listed.
    pub(in crate::app) evaluations: Option<TreePath>,
    /// Whether the mouse rests on one of these values.
    pub(in crate::app) around: bool,
    /// The texture that is shown.
    pub(in crate::app) texture: Option<TextureRequest>,
    /// The modes whose thumbnails are in sight, by their slugs.
    pub(in crate::app) thumbnails: BTreeSet<String>,
    /// Width and height of a thumbnail, points.
    pub(in crate::app) thumbnail_size: [f32; 2],
    /// The mode that the mouse rests on, which the picture previews.
    pub(in crate::app) preview: Option<String>,
    /// Whether there is an arrangement of the user's own to go back to.
    pub(in crate::app) has_own_arrangement: bool,
}

/// The user interface as the rest of the window knows it. A request is carried out once.
#[derive(Default)]
pub(in crate::app) struct Workspace {
    requests: Vec<PanelRequest>,
    pub(in crate::app) sight: Sight,
    /// Whether the legend over the picture has a histogram of its values.
    pub(in crate::app) shows_histogram: bool,
}

impl Workspace {
    /// Asks for a change in the next frame.
    pub(in crate::app) fn request(&mut self, request: PanelRequest) {
        match request {
            PanelRequest::ToggleHistogram => self.shows_histogram ^= true,
            request => self.requests.push(request),
        }
    }

    /// Asks for a change that the user must see: hidden panels are shown.
    pub(in crate::app) fn request_in_sight(&mut self, request: PanelRequest) {
        self.requests.extend([PanelRequest::Unhide, request]);
    }

    /// The requests since the last frame, in their order.
    pub(in crate::app) fn take_requests(&mut self) -> Vec<PanelRequest> {
        std::mem::take(&mut self.requests)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_are_carried_out_once_and_in_order() {
        let mut workspace = Workspace::default();
        workspace.request(PanelRequest::Toggle);
        workspace.request(PanelRequest::Unhide);
        workspace.request(PanelRequest::Open(Panel::TIMELINE));
        let all = [PanelRequest::Toggle, PanelRequest::Unhide, PanelRequest::Open(Panel::TIMELINE)];
        assert_eq!(workspace.take_requests(), all);
        assert_eq!(workspace.take_requests(), []);
    }
}
