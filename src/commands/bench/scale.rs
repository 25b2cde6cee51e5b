//! `bench scale`: how the time of a frame grows with the number of primitives, of materials, of joints and of lights.

mod joints;
mod lights;
mod steps;
pub(super) mod textures;

use std::sync::Arc;

use glam::{Mat4, Vec3};
use serde_json::{Value, json};
use specula::headless::Headless;
use specula::interface::Vertex;
use specula::scene::{Instance, Material, Model, Primitive, Topology, built_in};

use super::context::Bench;
use crate::commands::Failure;
use steps::{Growth, Times, frames, turned};

/// Numbers of primitives, with [`MATERIALS`] materials.
const PRIMITIVES: [usize; 5] = [10, 100, 1_000, 10_000, 100_000];
/// Numbers of materials, each of as many primitives.
const MATERIALS: [usize; 4] = [10, 100, 1_000, 10_000];
/// The built-in model whose material and first triangle are copied.
const BASE: &str = "ior";

/// Draws a grid of triangles while the camera turns, for each number of primitives and of materials, then a mesh that joints move.
pub(super) fn scale(bench: &Bench<'_>) -> Result<Value, Failure> {
    let (source, settings) = (bench.args.common.source()?, bench.args.common.settings()?);
    let mut headless = bench.renderer(source, settings, grid(1, 1)?)?;
    let of_primitives = PRIMITIVES.map(|count| (count, count.min(MATERIALS[0])));
    let of_materials = MATERIALS.map(|count| (count, count));
    Ok(json!({
        "size": [bench.args.common.size().0, bench.args.common.size().1],
        "primitives": series(bench, &mut headless, &of_primitives)?,
        "materials": series(bench, &mut headless, &of_materials)?,
        "lights": lights::lights(bench, &mut headless)?,
        "joints": joints::joints(bench, &mut headless)?,
    }))
}

/// Times frames of each number of primitives and materials. `growth` is the factor by which the CPU time grows from the step before.
fn series(bench: &Bench<'_>, headless: &mut Headless, steps: &[(usize, usize)]) -> Result<Vec<Value>, Failure> {
    let (mut found, mut growth) = (Vec::new(), Growth::default());
    for (index, (primitives, materials)) in steps.iter().enumerate() {
        bench.progress.begin("step", (index, steps.len()), &format!("{primitives} primitives, {materials} materials"));
        headless.set_model(grid(*primitives, *materials)?)?;
        let Times { cpu, device } = frames(bench, headless, turned)?;
        let growth = growth.to(cpu["min"].as_f64());
        found.push(json!({
            "primitives": primitives,
            "materials": materials,
            "draws": headless.draw_counts().draws,
            "cpu_ms": cpu,
            "device_ms": device,
            "growth": growth,
        }));
    }
    Ok(found)
}

/// A cube of as many triangles, each a primitive. Its materials have different colors and equal pipelines.
pub(super) fn grid(primitives: usize, materials: usize) -> Result<Model, Failure> {
    let missing = || Failure::Input(format!("the built-in model {BASE} is missing"));
    let base = built_in(BASE).and_then(Result::ok).ok_or_else(missing)?;
    let first = base.primitives.first().ok_or_else(missing)?;
    let instance = base.instances.first().ok_or_else(missing)?;
    let color = |index: usize| index as f32 / materials.max(1) as f32;
    let material = |index: usize| {
        let mut material: Material = base.materials[first.material].clone();
        material.numbers.base_color_factor = [color(index), 0.5, 1.0 - color(index), 1.0];
        material
    };
    let corners: Vec<Vertex> = first.indices.iter().take(3).map(|index| first.vertices[*index as usize]).collect();
    let triangle = |index: usize| Primitive {
        name: first.name.clone(),
        vertices: corners.clone(),
        indices: vec![0, 1, 2],
        topology: Topology::Triangles,
        material: index % materials,
        default_material: index % materials,
        variant_materials: Vec::new(),
        deformation: None,
        ..*first
    };
    let side = (primitives as f64).cbrt().ceil() as usize;
    let size = base.bounds.max - base.bounds.min;
    let place = |index: usize| {
        let cell = Vec3::new((index % side) as f32, (index / side % side) as f32, (index / side / side) as f32);
        let corner = base.bounds.min + size * cell / side as f32;
        let world_from_object = Mat4::from_translation(corner) * Mat4::from_scale(Vec3::splat(1.0 / side as f32));
        Instance { primitive: index, world_from_object, ..instance.clone() }
    };
    Ok(Model {
        materials: Arc::new((0..materials).map(material).collect()),
        primitives: Arc::new((0..primitives).map(triangle).collect()),
        instances: (0..primitives).map(place).collect(),
        ..base.clone()
    })
}
