//! The uniform blocks of declared passes.

use std::collections::BTreeMap;

use super::inputs::Clock;
use super::pipelines::PipelineRequest;
use crate::settings::Settings;
use crate::shader::graph::Input;
use crate::shader::{ShaderSet, values};

/// The uniform blocks of declared passes, by the place of the pass in [`PipelineRequest::passes`] and the binding.
pub(crate) type PassBlocks = BTreeMap<(usize, u32), Vec<u8>>;

pub(super) fn pass_blocks(
    settings: &Settings,
    shaders: &ShaderSet,
    pipelines: &PipelineRequest,
    size: (u32, u32),
    clock: Clock,
) -> PassBlocks {
    let mut blocks = PassBlocks::new();
    for (index, pass) in pipelines.passes.iter().enumerate() {
        for (binding, input) in &pass.inputs {
            let block = match input {
                Input::Parameters(bytes, members) => {
                    values::block(&settings.shader, &shaders.parameters, members, *bytes)
                }
                Input::Pass(bytes, members) => properties(pass.desc.size.pixels(size), clock, *bytes, members),
                _ => continue,
            };
            blocks.insert((index, *binding), block);
        }
    }
    blocks
}

/// The content of a pass's block `Pass`.
fn properties((width, height): (u32, u32), clock: Clock, bytes: u32, members: &[(u32, String)]) -> Vec<u8> {
    let mut block = vec![0; bytes as usize];
    for (offset, name) in members {
        let value = match name.as_str() {
            "size_px" => [width as f32, height as f32].map(f32::to_le_bytes).concat(),
            "mouse_px" => clock.mouse_px.map(f32::to_le_bytes).concat(),
            "date" => clock.date.parts().map(f32::to_le_bytes).concat(),
            "time_s" => clock.time_s.to_le_bytes().to_vec(),
            "delta_s" => clock.delta_s.to_le_bytes().to_vec(),
            "frame_index" => clock.frame_index.to_le_bytes().to_vec(),
            _ => continue,
        };
        let at = *offset as usize;
        if let Some(place) = block.get_mut(at..at + value.len()) {
            place.copy_from_slice(&value);
        }
    }
    block
}
