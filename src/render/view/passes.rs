//! The model on its way to HDR: opaque surfaces, what light passes through, the sky, and what is blended.

use std::sync::Arc;

use glam::Vec3;

use crate::gpu::{Attachments, Encoder, Image, Rect, SetLayouts, Use, vk};
use crate::interface::{ALPHA_BLEND, FEATURE_TRANSMISSION};

use crate::render::frame::FrameInput;
use crate::render::scene::{GpuDraw, GpuScene};
use crate::render::targets::Targets;
use crate::render::wanted::{MaterialVariant, PipelineKey, Wanted};

/// Draws the scene, or `only` a part of it, to the HDR target and resolves it, which leaves color in [`Use::Color`].
pub(super) fn draw_model(
    encoder: &mut Encoder,
    layouts: &Arc<SetLayouts>,
    targets: &Targets,
    input: &FrameInput<'_>,
    only: Option<Rect>,
) {
    encoder.transition(&targets.color, Use::Undefined, Use::Color);
    encoder.transition(&targets.depth, Use::Undefined, Use::Depth);
    let (color, resolve) = match &targets.multisampled {
        Some(multisampled) => {
            encoder.transition(multisampled, Use::Undefined, Use::Color);
            (multisampled, Some(&targets.color))
        }
        None => (&targets.color, None),
    };
    let (width, height) = targets.purpose.size;
    let attachments = Attachments {
        color,
        clear: Some([0.0; 4]),
        resolve,
        depth: Some(&targets.depth),
        goes_on: targets.behind.is_some(),
        area: Rect { x: 0, y: 0, width, height },
    };
    let (opaque, passed, blended) = input.scene.map(|scene| sorted(scene, input.shot.view.eye)).unwrap_or_default();
    if let Some(behind) = &targets.behind {
        draw_behind(encoder, layouts, targets, input, &opaque, &attachments, behind);
    }
    let last = Attachments { goes_on: false, ..attachments };
    // The mode may show opaque surfaces otherwise than they are seen through others.
    let is_drawn = targets.behind.is_some() && !input.pipelines.is_some_and(|(_, wanted)| wanted.has_own_behind());
    encoder.begin_rendering(&Attachments { clear: last.clear.filter(|_| !is_drawn), ..last });
    if let Some(only) = only {
        encoder.set_scissor(only);
    }
    encoder.bind_set(layouts, &targets.model_set);
    if !is_drawn {
        draw_primitives(encoder, layouts, input, &opaque, Wanted::model_key);
    }
    draw_primitives(encoder, layouts, input, &passed, Wanted::model_key);
    if let Some((pipelines, wanted)) = input.pipelines
        && let Some(pipeline) = wanted.sky_key().and_then(|key| pipelines.get(&key))
    {
        encoder.bind_pipeline(&pipeline);
        encoder.set_raster(
            vk::PrimitiveTopology::TRIANGLE_LIST,
            vk::CullModeFlags::NONE,
            vk::FrontFace::COUNTER_CLOCKWISE,
        );
        encoder.draw(3);
    }
    draw_primitives(encoder, layouts, input, &blended, Wanted::model_key);
    encoder.end_rendering();
}

/// Draws what is opaque. Its picture, blurred level by level, is what surfaces that light passes through show of what lies
/// behind them.
fn draw_behind(
    encoder: &mut Encoder,
    layouts: &Arc<SetLayouts>,
    targets: &Targets,
    input: &FrameInput<'_>,
    opaque: &[&GpuDraw],
    attachments: &Attachments<'_>,
    behind: &Arc<Image>,
) {
    encoder.transition(behind, Use::Undefined, Use::Sampled);
    encoder.begin_rendering(attachments);
    encoder.bind_set(layouts, &targets.model_set);
    draw_primitives(encoder, layouts, input, opaque, Wanted::behind_key);
    encoder.end_rendering();
    encoder.transition(&targets.color, Use::Color, Use::CopyFrom);
    encoder.transition(behind, Use::Sampled, Use::CopyTo);
    encoder.fill_levels(&targets.color, behind);
    encoder.transition(behind, Use::CopyFrom, Use::Sampled);
    encoder.transition(&targets.color, Use::CopyFrom, Use::Color);
    encoder.transition(&targets.depth, Use::Depth, Use::Depth);
    if let Some(multisampled) = &targets.multisampled {
        encoder.transition(multisampled, Use::Color, Use::Color);
    }
}

/// Adds the newest frame to the mean of those before it, and leaves the mean in [`Use::Sampled`].
pub(super) fn average(
    encoder: &mut Encoder,
    layouts: &Arc<SetLayouts>,
    targets: &Targets,
    input: &FrameInput<'_>,
    only: Option<Rect>,
    index: u32,
) {
    let (Some(mean), Some((pipelines, wanted))) = (&targets.mean, input.pipelines) else { return };
    let Some(pipeline) = wanted.average_key().and_then(|key| pipelines.get(&key)) else { return };
    encoder.transition(mean, if index == 0 { Use::Undefined } else { Use::Sampled }, Use::Color);
    let (width, height) = targets.purpose.size;
    encoder.begin_rendering(&Attachments {
        color: mean,
        clear: (index == 0).then_some([0.0; 4]),
        resolve: None,
        depth: None,
        goes_on: false,
        area: Rect { x: 0, y: 0, width, height },
    });
    if let Some(only) = only {
        encoder.set_scissor(only);
    }
    encoder.bind_pipeline(&pipeline);
    encoder.set_weight(1.0 / (index as f32 + 1.0));
    encoder.bind_set(layouts, &targets.color_set);
    encoder.draw(3);
    encoder.end_rendering();
    encoder.transition(mean, Use::Color, Use::Sampled);
}

/// HDR to the picture, which the rest of the output surrounds: exposure, tone map, sRGB.
pub(super) fn tone_map(
    encoder: &mut Encoder,
    layouts: &Arc<SetLayouts>,
    targets: &Targets,
    input: &FrameInput<'_>,
    only: Option<Rect>,
    output: &Attachments<'_>,
) {
    encoder.begin_rendering(output);
    if let Some(pipeline) = input.pipelines.and_then(|(set, wanted)| set.get(&wanted.tonemap_key())) {
        encoder.set_viewport(input.rect);
        if let Some(only) = only {
            encoder.set_scissor(only);
        }
        encoder.bind_pipeline(&pipeline);
        encoder.bind_set(layouts, &targets.picture_set);
        encoder.draw(3);
    }
    encoder.end_rendering();
}

fn draw_primitives(
    encoder: &mut Encoder,
    layouts: &Arc<SetLayouts>,
    input: &FrameInput<'_>,
    draws: &[&GpuDraw],
    key: fn(&Wanted, MaterialVariant) -> PipelineKey,
) {
    let (Some(scene), Some((pipelines, wanted))) = (input.scene, input.pipelines) else { return };
    encoder.keep(&scene.vertices);
    encoder.bind_indices(&scene.indices);
    for draw in draws {
        if let Some(pipeline) = pipelines.get(&key(wanted, draw.variant)) {
            encoder.bind_pipeline(&pipeline);
            draw_primitive(encoder, layouts, scene, draw);
        }
    }
}

fn draw_primitive(encoder: &mut Encoder, layouts: &Arc<SetLayouts>, scene: &GpuScene, draw: &GpuDraw) {
    encoder.bind_set(layouts, &scene.materials[draw.material]);
    encoder.push(layouts, &draw.push);
    // Both faces of a transparent surface are blended in order: the far one, seen from inside, first.
    let passes: &[vk::CullModeFlags] = match (draw.double_sided, draw.variant.alpha) {
        (true, ALPHA_BLEND) => &[vk::CullModeFlags::FRONT, vk::CullModeFlags::BACK],
        (true, _) => &[vk::CullModeFlags::NONE],
        (false, _) => &[vk::CullModeFlags::BACK],
    };
    for cull in passes {
        encoder.set_raster(draw.topology, *cull, draw.front);
        encoder.draw_indexed(draw.index_count, draw.first_index);
    }
}

/// Opaque and masked primitives front to back, which saves shading; those that light passes through, and blended ones, back to
/// front, which they need.
fn sorted(scene: &GpuScene, eye: Vec3) -> (Vec<&GpuDraw>, Vec<&GpuDraw>, Vec<&GpuDraw>) {
    let mut sorted: Vec<_> = scene.draws.iter().collect();
    sorted.sort_by(|a, b| a.center_ws.distance_squared(eye).total_cmp(&b.center_ws.distance_squared(eye)));
    let (mut opaque, mut passed, mut blended) = (Vec::new(), Vec::new(), Vec::new());
    for draw in sorted {
        match draw.variant {
            v if v.alpha == ALPHA_BLEND => blended.insert(0, draw),
            v if v.features & FEATURE_TRANSMISSION != 0 => passed.insert(0, draw),
            _ => opaque.push(draw),
        }
    }
    (opaque, passed, blended)
}
