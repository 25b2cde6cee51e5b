//! Thumbnails of debug modes: which modes are drawn together, and what such a drawing needs.

use super::pipelines::PipelineRequest;
use super::{Scene, TargetFormat};
use crate::settings::Settings;
use crate::shader::graph::RenderPhase;
use crate::shader::{DrawAs, Mode, ShaderSet};

/// A mode that is drawn together with others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SharedMode {
    /// Value of `MODE`.
    pub id: u32,
    /// `interface::ENCODE_*`.
    pub encode: u32,
}

/// Splits modes into sets that are drawn at once: a draw processes the vertices once, and one pipeline computes up to `most`
/// modes. The modes of a set share a stage, a group, the background and the kind of tone mapping, so that a set compiles little
/// code that only one of its modes needs. Path-traced modes and images of passes have no thumbnail and are in no set. A mode that
/// draws lines or layers, and the final picture, are sets of their own, drawn with the pipelines of the window's view.
pub fn mode_sets<'a>(modes: impl IntoIterator<Item = &'a Mode>, most: usize) -> Vec<Vec<&'a Mode>> {
    let mut sets: Vec<Vec<&Mode>> = Vec::new();
    for mode in modes.into_iter().filter(|mode| has_thumbnail(mode)) {
        let fits =
            |set: &&mut Vec<&Mode>| set.len() < most && is_shared(mode) && set.iter().all(|o| go_together(mode, o));
        match sets.iter_mut().rev().find(fits) {
            Some(set) => set.push(mode),
            None => sets.push(vec![mode]),
        }
    }
    sets
}

/// Whether a thumbnail of the mode can be drawn in a fraction of a frame.
fn has_thumbnail(mode: &Mode) -> bool {
    mode.pass.is_none() && !mode.follows_paths()
}

/// Whether the mode can be one of several that a pipeline computes.
fn is_shared(mode: &Mode) -> bool {
    mode.draw == DrawAs::Surfaces && mode.id != crate::interface::MODE_FINAL
}

fn go_together(a: &Mode, b: &Mode) -> bool {
    is_shared(b) && (&a.stage, &a.group, a.tonemap, a.through) == (&b.stage, &b.group, b.tonemap, b.through)
}

impl PipelineRequest {
    /// The pipelines that draw these modes at once. `modes` is one of [`mode_sets`].
    pub(crate) fn of_modes(
        settings: &Settings,
        shaders: &ShaderSet,
        scene: Option<&Scene>,
        target: TargetFormat,
        modes: &[&Mode],
    ) -> Self {
        let mode = modes.first().map(|mode| mode.slug.clone()).unwrap_or_default();
        let mut request = Self::new(&Settings { mode, ..settings.clone() }, shaders, scene, target);
        request
            .passes
            .retain(|pass| matches!(pass.phase, RenderPhase::BeforeModel | RenderPhase::Model | RenderPhase::Tonemap));
        (request.wireframe, request.wireframe_stage) = (None, String::new());
        if modes.len() > 1 {
            request.modes = modes.iter().map(|mode| SharedMode { id: mode.id, encode: mode.encode.id() }).collect();
        }
        request
    }
}
