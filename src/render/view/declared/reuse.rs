//! Tells whether a pass would draw the same image again. Then it is not drawn: while only the camera moves, shadow maps stay.

use std::sync::Arc;

use super::PassContext;
use super::cache_key::PassCacheKey;
use super::images::Images;
use crate::gpu::{Pipeline, ResourceUsage};
use crate::interface::{BINDING_FEW_LIGHTS, BINDING_FRAME, BINDING_LIGHT_GRID, BINDING_LIGHTS, BINDING_PARAMS};
use crate::shader::GraphPass;
use crate::shader::annotation::pass::PassTarget;
use crate::shader::graph::Input;

/// The inputs of a pass in this frame. `None` if one of them changes with every frame, or cannot be compared.
///
/// `pipelines`: those that draw it. `instances`: how often each draws the model; 0: not at all. `index`: its place in
/// `PipelineRequest::passes`.
pub(super) fn cache_key(
    pass: &GraphPass,
    index: usize,
    pipelines: &[&Arc<Pipeline>],
    instances: u32,
    context: &PassContext<'_>,
    images: &Images,
) -> Option<PassCacheKey> {
    if pass.is_compute || pass.desc.to != PassTarget::Image || pass.desc.keep {
        return None;
    }
    if pass.desc.images().any(|(name, _)| images.is_shared(name)) {
        return None;
    }
    // Each frame reports the loops that it has cut short.
    if pipelines.iter().any(|pipeline| pipeline.names_loops()) {
        return None;
    }
    let usage = pipelines.iter().fold(ResourceUsage::default(), |all, pipeline| all.union(&pipeline.usage));
    let (frame, state) = (context.frame, &context.frame.state);
    let mut from = PassCacheKey::default();
    pipelines.iter().for_each(|pipeline| from.object(pipeline));
    for (binding, input) in pass.inputs.iter().filter(|(binding, _)| usage.pass_bindings.contains(binding)) {
        match input {
            input if input.is_of_picture() => return None,
            Input::Image(name) => from.images.push(images.drawn_at(name)),
            Input::Texture(name, kind) => {
                frame.pipelines.textures().get(name, *kind).into_iter().for_each(|(i, _)| from.object(i))
            }
            _ => {
                from.bytes.extend(state.pass_blocks().get(&(index, *binding)).into_iter().flatten());
            }
        }
    }
    let constants = bytemuck::bytes_of(context.constants);
    for bytes in &usage.frame_bytes {
        from.bytes.extend(constants.get(bytes.start..bytes.end.min(constants.len())).into_iter().flatten());
    }
    if usage.frame_bindings.contains(&BINDING_LIGHTS) || usage.frame_bindings.contains(&BINDING_FEW_LIGHTS) {
        from.bytes.extend_from_slice(bytemuck::cast_slice(&frame.lights()));
    }
    if usage.frame_bindings.contains(&BINDING_LIGHT_GRID) {
        from.bytes.extend_from_slice(state.light_grid.bytes());
    }
    if usage.frame_bindings.contains(&BINDING_PARAMS) {
        from.bytes.extend_from_slice(state.params());
    }
    const BLOCKS: [u32; 5] = [BINDING_FRAME, BINDING_FEW_LIGHTS, BINDING_LIGHTS, BINDING_LIGHT_GRID, BINDING_PARAMS];
    let is_block = |binding: &u32| BLOCKS.contains(binding);
    if !usage.frame_bindings.iter().all(is_block) {
        from.object(&frame.environment);
        from.object(&frame.tables);
        from.object(&frame.measured);
        from.object(&frame.path_tracing);
    }
    if instances > 0 {
        from.bytes.extend(instances.to_le_bytes());
        context.placed.iter().for_each(|placed| from.object(*placed));
    }
    Some(from)
}
