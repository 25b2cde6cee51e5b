//! `bench scale`: how the time to upload a model and the memory grow with its textures, up to 4 GiB or to what the device has.

use std::sync::Arc;
use std::time::Instant;

use glam::Affine2;
use serde_json::{Value, json};
use specula::gpu::MemoryUse;
use specula::interface::TEXTURE_BASE_COLOR;
use specula::scene::{Image, Model, Sampler, Texture, TextureUse, mips};

use super::grid;
use super::steps::Growth;
use crate::commands::Failure;
use crate::commands::bench::context::Bench;
use crate::commands::bench::samples::round;

/// Sizes of all textures with their mip levels, MiB.
const TOTALS: [u64; 7] = [16, 64, 256, 512, 1024, 2048, 4096];
/// Width and height of a texture, texels. With its levels it takes 21.3 MiB.
const SIDE: u32 = 2048;
/// Memory that is left for render targets and other processes, MiB.
const RESERVE: u64 = 128;

/// Uploads and draws models with more and more textures. `growth` is the factor by which the time of the upload grows from the step before. A
/// step for which the device has not enough memory says so in `skipped`.
pub(in crate::commands::bench) fn series(bench: &Bench<'_>) -> Result<Vec<Value>, Failure> {
    let (source, settings) = (bench.args.common.source()?, bench.args.common.settings()?);
    let mut headless = bench.renderer(source, settings, grid(1, 1)?)?;
    let totals: Vec<u64> = TOTALS.into_iter().filter(|mib| *mib <= bench.args.texture_mib).collect();
    let (mut found, mut growth) = (Vec::new(), Growth::default());
    for (index, mib) in totals.iter().enumerate() {
        bench.progress.begin("step", (index, totals.len()), &format!("{mib} MiB of textures"));
        // The model of the step before would take memory beside the next one.
        headless.set_model(grid(1, 1)?)?;
        headless.draw()?;
        let memory = bench.gpu.memory();
        let free = free_mib(&memory);
        let mut step = json!({ "texture_mib": mib, "free_mib": free });
        if mib + RESERVE > free {
            step["skipped"] = json!(format!(
                "the device has {free} MiB free, and {mib} MiB of textures with {RESERVE} MiB for the frame do not fit"
            ));
            found.push(step);
            continue;
        }
        let model = textured(mib << 20)?;
        step["textures"] = json!(model.images.len());
        let start = Instant::now();
        let uploaded = headless.set_model(model);
        let upload_ms = start.elapsed().as_secs_f64() * 1e3;
        if let Err(error) = uploaded {
            step["skipped"] = json!(error.to_string());
            found.push(step);
            continue;
        }
        let start = Instant::now();
        headless.draw()?;
        step["upload_ms"] = json!(round(upload_ms));
        step["first_frame_ms"] = json!(round(start.elapsed().as_secs_f64() * 1e3));
        step["device_mib"] = json!(bench.gpu.memory().used.saturating_sub(memory.used) >> 20);
        step["growth"] = json!(growth.to(Some(upload_ms)));
        found.push(step);
    }
    Ok(found)
}

/// Free memory of the device's largest heap, MiB: its budget where the driver reports one, else its size.
fn free_mib(memory: &MemoryUse) -> u64 {
    let free = |heap: &specula::gpu::Heap| match heap.used_of {
        Some([used, budget]) => budget.saturating_sub(used),
        None => heap.size.saturating_sub(memory.reserved),
    };
    memory.heaps.iter().filter(|heap| heap.is_device).map(free).max().unwrap_or(0) >> 20
}

/// A cube of triangles, each with a material and a texture of its own, whose levels take `bytes` in all: large ones, and a smaller one for the
/// rest.
fn textured(bytes: u64) -> Result<Model, Failure> {
    let each = mips::bytes(SIDE, SIDE) as u64;
    let mut sides = vec![SIDE; (bytes / each) as usize];
    // Three quarters of a texture with levels are its largest level.
    let rest = (((bytes % each) as f64 * 0.75 / 4.0).sqrt() as u32).max(1);
    sides.push(rest);
    let mut model = grid(sides.len(), sides.len())?;
    let image = |(index, side): (usize, &u32)| {
        let color = [index as u8, (index >> 8) as u8, 128, 255];
        Image::rgba8(format!("texture {index}"), *side, *side, color.repeat((side * side) as usize))
    };
    let texture = |image| Texture { image, sampler: Sampler::default() };
    model.images = Arc::new(sides.iter().enumerate().map(image).collect());
    model.textures = Arc::new((0..sides.len()).map(texture).collect());
    for (texture, material) in Arc::make_mut(&mut model.materials).iter_mut().enumerate() {
        let used = TextureUse { texture, uv_set: 0, uv_from_mesh: Affine2::IDENTITY };
        material.textures[TEXTURE_BASE_COLOR as usize] = Some(used);
    }
    Ok(model)
}
