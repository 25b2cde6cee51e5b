//! Blended surfaces sorted in each pixel, by depth peeling from back to front (Everitt 2001, "Interactive Order-Independent
//! Transparency"), so that surfaces which intersect or interleave blend in the right order.
//!
//! For each layer, the stage `peel.frag` of the tree draws the depth of all blended surfaces: the farthest that is in front
//! of the last layer remains, in each sample. Then the surfaces are drawn as without sorting, where their depth is equal to
//! that. Both draws have the same pre-rasterization stages and constants, and `pbr.vert` says `invariant gl_Position`, so
//! their depths are equal. Each fragment is shaded once; a layer costs the vertices twice.
//!
//! Surfaces at the depth of an opaque one, such as decals, come first. What lies in front of the last layer comes last, in
//! the order of its primitives.

use super::declared::PassSets;
use super::model_draws::{Draws, instances};
use super::passes::Passes;
use super::peel_images::{PeelImages, PeelTarget};
use crate::frame::PipelineRequest;
use crate::gpu::{Encoder, Use, vk};
use crate::render::scene::SortedDraws;

/// Depth of the near plane.
const NEAR: f32 = 1.0;

impl Passes<'_> {
    /// Draws the blended surfaces, layer by layer. `begin` begins rendering to the color targets and a depth target; both, and the depth
    /// of the scene, are in their uses as targets before and after.
    pub(super) fn peel(
        &self,
        encoder: &mut Encoder,
        sorted: &SortedDraws,
        images: &PeelImages<'_>,
        begin: impl Fn(&mut Encoder, &PeelTarget<'_>),
    ) {
        let request = &self.frame.state.pipelines;
        let scene = &self.targets.depth;
        let shade = |encoder: &mut Encoder, compare: vk::CompareOp| {
            encoder.set_depth_test(compare);
            self.draw(encoder, sorted, &sorted.blended, PipelineRequest::model_key);
        };
        begin(encoder, &PeelTarget { depth: scene, clear_depth: None, is_shaded: true });
        shade(encoder, vk::CompareOp::EQUAL);
        encoder.end_rendering();
        encoder.transition(scene, Use::Depth, Use::Sampled);
        let last = request.peeling.layers.saturating_sub(1) as usize;
        for layer in 0..=last {
            let depth = &images.layers[layer % 2];
            encoder.transition(depth, Use::Undefined, Use::Depth);
            self.wait_for_color(encoder);
            begin(encoder, &PeelTarget { depth, clear_depth: Some(NEAR), is_shaded: false });
            encoder.set_depth_test(vk::CompareOp::LESS);
            self.draw_depth(encoder, sorted, &images.sets[if layer == 0 { 0 } else { 1 + (layer - 1) % 2 }]);
            encoder.end_rendering();
            encoder.transition(depth, Use::Depth, Use::Depth);
            self.wait_for_color(encoder);
            begin(encoder, &PeelTarget { depth, clear_depth: None, is_shaded: true });
            shade(encoder, vk::CompareOp::EQUAL);
            if layer == last {
                shade(encoder, vk::CompareOp::GREATER);
            }
            encoder.end_rendering();
            encoder.transition(depth, Use::Depth, Use::Sampled);
        }
        encoder.transition(scene, Use::Sampled, Use::Depth);
    }

    /// Draws the depth of the next layer.
    fn draw_depth(&self, encoder: &mut Encoder, sorted: &SortedDraws, sets: &PassSets) {
        let request = &self.frame.state.pipelines;
        let Some(pass) = request.peel_pass() else { return };
        let passes = Passes { sets, ..*self };
        let model = passes.model_draws(pass, instances(self.frame, pass));
        let draws = Draws { runs: &sorted.blended, commands: &sorted.commands, buffer: sorted.buffer.as_ref() };
        model.draw(encoder, &draws, |material| request.peel_key(material));
    }

    /// SYNC: orders what is drawn next to the color targets after what has been drawn.
    fn wait_for_color(&self, encoder: &mut Encoder) {
        let more = self.more.iter().map(|target| target.drawn());
        let first = self.targets.multisampled.as_ref().unwrap_or(&self.targets.color);
        std::iter::once(first).chain(more).for_each(|image| encoder.transition(image, Use::Color, Use::Color));
    }
}
