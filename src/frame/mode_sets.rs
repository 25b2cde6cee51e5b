//! Thumbnails of debug modes: which modes are drawn together, and what such a drawing needs.

use crate::shader::{DrawAs, Mode};

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
