//! Reads glTF 2.0 into a [`Model`]. The `gltf` crate parses the JSON. This module checks and reads all other data, since the
//! crate's own readers panic on invalid files and refuse some valid ones.

mod compression;
mod environment;
mod file;
mod geometry;
mod instancing;
mod left_out;
pub(super) mod materials;
mod memory;
mod motion;
mod nodes;
mod objects;
mod place;
mod placing;
#[cfg(test)]
mod tests;
mod unseen;
pub(super) mod values;
mod variants;

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::*;

use self::file::buffers::{Buffers, Files};
use self::file::container;
pub use self::file::opened::find_model;
use self::file::opened::{self, Opened, Place};
use self::geometry::accessor::Reader;
use self::geometry::mesh::{self, Geometry};
use self::geometry::tangents;
pub use self::geometry::triangles::triangles;
use self::left_out::{LeftOut, Part};
use self::materials::{images, material, placeholder};
use self::motion::raw::Raw;
use self::motion::{animations, pointers, skins};
use super::background;
use super::error::Problem;
use super::load_options::{Caller, Canceled, LoadOptions, TakeEarly};
use super::model::{Contents, Image, LoadTiming, Material, Model};
use super::motion::Motion;
use crate::interface::MAX_LIGHTS;
use crate::message::catch_panic;

/// Loads a file, the model in a folder, or that in a zip archive. Adds every file that it reads or looks for to `tried`, even if the load fails.
pub fn load_file(
    path: &Path,
    options: &LoadOptions,
    caller: Caller<'_>,
    tried: &mut Vec<PathBuf>,
) -> Result<Model, Problem> {
    let start = Instant::now();
    let path = std::path::absolute(path).map_err(Problem::Read)?;
    tried.push(path.clone());
    let Opened { path, name, bytes, place } = opened::open(&path)?;
    let stored = path.metadata().map_or(0, |metadata| metadata.len());
    *tried = vec![path];
    let files = Files::new((place, stored), options.allow_outside, caller.canceled, tried);
    guarded(&name, &bytes, files, (options.scene, caller.take_early), start)
}

/// Loads a self-contained model.
pub fn load_memory(name: &str, bytes: &[u8]) -> Result<Model, Problem> {
    let mut tried = Vec::new();
    let files = Files::new((Place::Nowhere, bytes.len() as u64), false, &|| false, &mut tried);
    guarded(name, bytes, files, (None, None), Instant::now())
}

/// Builds the model and turns a panic into an error. A panic is a bug in Specula, but a file that triggers it must not end
/// the session.
fn guarded(
    name: &str,
    bytes: &[u8],
    files: Files<'_>,
    wanted: (Option<usize>, Option<TakeEarly<'_>>),
    start: Instant,
) -> Result<Model, Problem> {
    catch_panic(|| build(name, bytes, files, wanted, start)).unwrap_or_else(|found| Err(Problem::Refused { found }))
}

fn build(
    name: &str,
    bytes: &[u8],
    mut files: Files<'_>,
    (scene, take_early): (Option<usize>, Option<TakeEarly<'_>>),
    start: Instant,
) -> Result<Model, Problem> {
    let container::Document { mut root, raw, bin, mut warnings } = container::parse(bytes)?;
    let mut left_out = LeftOut::default();
    let mut buffers = Buffers::load(&root, bin, &mut files, &mut left_out)?;
    compression::decode(&mut root, &mut buffers, &files.memory, &mut left_out, files.canceled)?;
    let scene_index = nodes::chosen_scene(&root, scene);
    let environment = environment::read(&root, &buffers, &mut files, scene_index, &mut warnings);
    let reader = Reader { root: &root, buffers: &buffers, memory: &files.memory };
    let mut scene = nodes::walk(&root, scene, &pointers::switched_nodes(&raw.animations))?;
    let weights = skins::attach(reader, &raw, &mut scene);
    left_out.append(std::mem::take(&mut scene.left_out));
    let (clips, values) = animations::read((reader, scene_index), &raw.animations, &scene.rig, &mut left_out);
    let material::Materials { materials, textures, images, warnings: material_warnings } =
        material::read(&root, &mut left_out);
    let variants = variants::names(&root, &mut warnings);
    let variants = left_out.unless(Part::VARIANTS, "extensions", variants).unwrap_or_default();
    let meshes = read_meshes(reader, &raw, &scene, &materials, variants.len(), &mut left_out)?;
    scene.meshes = instancing::expand(reader, scene.meshes, &mut left_out, &mut scene.warnings)?;
    let encoded: Vec<images::Encoded<'_>> =
        images.into_iter().map(|origin| images::find(&root, &buffers, &mut files, origin)).collect();
    warnings.append(&mut scene.warnings);
    warnings.extend(material_warnings);
    warnings.extend(left_out.warnings());
    let contents = Contents {
        scenes: root.scenes.iter().map(|scene| scene.name.clone().unwrap_or_default()).collect(),
        scene: scene_index,
        meshes: root.meshes.len(),
        animations: root.animations.iter().map(|clip| clip.name.clone().unwrap_or_default()).collect(),
        skins: root.skins.len(),
        extensions: root.extensions_used.clone(),
    };
    let model = Model {
        name: name.into(),
        materials: Arc::new(materials),
        textures: textures.into(),
        variants: variants.into(),
        files: files.tried.clone().into(),
        nodes: scene.nodes.into(),
        environment,
        contents: contents.into(),
        timing: LoadTiming { parse_ms: milliseconds(start), ..LoadTiming::default() },
        ..Model::default()
    };
    let motion = Motion { clips, rig: scene.rig, values, target_names: weights.names };
    let objects = placing::Objects { meshes: scene.meshes, lights: scene.lights, cameras: scene.cameras };
    let (canceled, memory) = (files.canceled, &files.memory);
    // Whoever takes the model early does so while the images are being decoded.
    let early =
        take_early.filter(|_| images::take_long(&encoded)).map(|take| (take, images::placeholders(&model, &encoded)));
    let is_early = early.is_some();
    let ((images, decode_ms), placed) = rayon::join(
        || timed(|| background::run_if(is_early, || images::decode(encoded, memory, canceled))),
        || {
            let (placed, place_warnings) = assemble(model, meshes, objects, (motion, weights.rest), canceled)?;
            if let Some((take, images)) = early {
                take(Model { images: images.into(), awaits_textures: true, ..placed.clone() });
            }
            Ok((placed, place_warnings))
        },
    );
    if canceled() {
        return Err(Problem::Canceled);
    }
    let (mut model, place_warnings): (Model, Vec<String>) = placed?;
    let (images, failures): (Vec<Image>, Vec<_>) = images.into_iter().map(|i| (i.image, i.failure)).unzip();
    if failures.iter().any(Option::is_some) {
        let materials: &mut Vec<Material> = Arc::make_mut(&mut model.materials);
        warnings.extend(placeholder::replace(materials, &model.textures, &failures));
    }
    warnings.extend(place_warnings);
    (model.images, model.warnings) = (images.into(), warnings.into());
    model.timing.decode_ms = decode_ms;
    Ok(model)
}

/// Completes the meshes and places them. Returns the model without images, and the warnings about what it has placed.
fn assemble(
    mut model: Model,
    meshes: Meshes,
    objects: placing::Objects,
    motion: (Motion, Vec<f32>),
    canceled: Canceled<'_>,
) -> Result<(Model, Vec<String>), Problem> {
    let (meshes, tangents_ms) = timed(|| finish_meshes(meshes, &model.materials, canceled));
    let mut warnings = Vec::new();
    let (mut ranges, mut primitives) = (HashMap::new(), Vec::new());
    for (mesh, geometries) in meshes {
        let first = primitives.len();
        for Geometry { primitive, warnings: more } in geometries {
            primitives.push(primitive);
            warnings.extend(more);
        }
        ranges.insert(mesh, first..primitives.len());
    }
    model.primitives = Arc::new(primitives);
    placing::place(&mut model, objects, motion, &ranges, &mut warnings)?;
    warnings.extend(unseen::reason(&model));
    if model.lights.len() > MAX_LIGHTS {
        warnings.push(format!("it has {} lights: the first {MAX_LIGHTS} shine.", model.lights.len()));
    }
    model.timing.tangents_ms = tangents_ms;
    Ok((model, warnings))
}

type Meshes = Vec<(usize, Vec<Geometry>)>;

/// Reads every mesh that the scene uses, once each.
///
/// # Errors
/// All primitives are left out.
fn read_meshes(
    reader: Reader<'_>,
    raw: &Raw,
    scene: &nodes::Scene,
    materials: &[Material],
    variants: usize,
    left_out: &mut LeftOut,
) -> Result<Meshes, Problem> {
    let mut used: Vec<usize> = scene.meshes.iter().map(|placed| placed.mesh).collect();
    used.sort_unstable();
    used.dedup();
    let mut joints: HashMap<usize, usize> = HashMap::new();
    for (mesh, skin) in scene.meshes.iter().filter_map(|placed| Some((placed.mesh, placed.skin?))) {
        let count = scene.rig.skins[skin].joints.len();
        joints.entry(mesh).and_modify(|least| *least = count.min(*least)).or_insert(count);
    }
    let read = |index| {
        let motion = (raw.mesh(index), joints.get(&index).copied());
        (index, mesh::read(reader, index, materials, variants, motion))
    };
    let read: Vec<(usize, (Vec<Geometry>, LeftOut))> = used.into_par_iter().map(read).collect();
    let mut meshes = Vec::with_capacity(read.len());
    for (index, (geometries, of_mesh)) in read {
        left_out.append(of_mesh);
        meshes.push((index, geometries));
    }
    match meshes.iter().all(|(_, geometries)| geometries.is_empty()) {
        true => std::mem::take(left_out).into_cause().map_or(Ok(meshes), Err),
        false => Ok(meshes),
    }
}

fn finish_meshes(mut meshes: Meshes, materials: &[Material], canceled: Canceled<'_>) -> Meshes {
    let mut all: Vec<&mut Geometry> = meshes.iter_mut().flat_map(|(_, geometries)| geometries).collect();
    tangents::complete(&mut all, materials, canceled);
    meshes
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = work();
    (result, milliseconds(start))
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
