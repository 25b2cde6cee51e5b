//! `specula info`: the devices, the shader tree, and what is in a model.

mod stages;

use serde_json::json;
use specula::gpu::{AdapterInfo, GpuError, adapters};
use specula::interface::{ATTRIBUTE_UV0, ATTRIBUTE_UV1, TEXTURES};
use specula::message::escape;
use specula::render::texel_forms;
use specula::scene::environment::ModelEnvironment;
use specula::scene::{Clip, Material, Model, Primitive, Skin, Topology, slot_name, texture_sources};

use super::common::{Common, Models};
use super::{Failure, print_json};
use stages::Stages;

/// Options of `info`.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    models: Models,
    /// Also list the stages of the picture: words of SPIR-V, compile times, and the driver's registers, instructions and spills
    #[arg(long)]
    stages: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    common: Common,
}

/// Runs the command. It works without Vulkan too, and then prints why there is no device.
pub fn run(mut args: Args) -> Result<(), Failure> {
    args.common.take_files(&mut args.models)?;
    let devices = adapters();
    let mut model = args.common.model(args.models.model.as_deref())?;
    settle(&mut model, args.common.device.as_deref());
    let source = args.common.source()?;
    let tree = source.location().map_or_else(|| "built in".to_owned(), |root| root.display().to_string());
    if args.json {
        let (devices, why_none) = devices.map_or_else(|e| (Vec::new(), Some(e.to_string())), |d| (d, None));
        let mut value = json!({ "version": env!("CARGO_PKG_VERSION"), "devices": devices, "why_no_device": why_none, "shaders": tree,
            "model": summary(&model) });
        if args.stages {
            value["picture"] = Stages::new(&args.common, model)?.json();
        }
        print_json(&value);
        return Ok(());
    }
    out!("specula     {}", env!("CARGO_PKG_VERSION"));
    out!("shaders     {}", escape(&tree));
    print_devices(devices);
    print_model(&model);
    if args.stages {
        let progress = super::progress::Progress::new(!args.common.emits());
        progress.say("compiling the shaders and building pipelines");
        let stages = Stages::new(&args.common, model)?;
        drop(progress);
        stages.print();
    }
    Ok(())
}

fn print_devices(devices: Result<Vec<AdapterInfo>, GpuError>) {
    out!("\nDevices");
    match devices {
        Ok(devices) if devices.is_empty() => out!("  none"),
        Ok(devices) => {
            for device in devices {
                out!("  {} ({})", escape(&device.name), device.kind);
                out!("    Vulkan {}, driver {}", device.api, escape(&device.driver));
                if let Some(why) = &device.refused {
                    out!("    cannot be used: {}", escape(why));
                }
            }
        }
        Err(error) => out!("  none: {error}"),
    }
}

/// Prints a line for each kind of thing in the model. The model's warnings are on stderr.
fn print_model(model: &Model) {
    let (vertices, _) = counts(model);
    let [width, height, depth] = size(model).to_array();
    let [x, y, z] = model.bounds.center().to_array();
    let variants: Vec<String> = model.variants.iter().map(|name| escape(name)).collect();
    out!("\nModel {}", escape(&model.name));
    out!("  size        {width:.3} x {height:.3} x {depth:.3} m, center {x:.3}, {y:.3}, {z:.3}");
    out!("  scenes      {}", count(model.contents.scenes.len()));
    out!("  nodes       {}", nodes(model));
    out!("  meshes      {}", count(model.contents.meshes));
    out!("  primitives  {}", model.primitives.len());
    out!("  instances   {}", model.instances.len());
    out!("  triangles   {}", triangles(model));
    out!("  vertices    {vertices}");
    out!("  UV sets     {}", count(uv_sets(model)));
    out!("  materials   {}", materials(model));
    out!("  variants    {}", if variants.is_empty() { "none".to_owned() } else { variants.join(", ") });
    out!("  lights      {}", count(model.lights.len()));
    if let Some(environment) = &model.environment {
        let name = if environment.name.is_empty() { String::new() } else { format!("{}: ", escape(&environment.name)) };
        let ModelEnvironment { side, intensity, .. } = **environment;
        out!("  environment {name}a cube of {side} x {side}, intensity {intensity} (--env model)");
    }
    out!("  cameras     {}", count(model.cameras.len()));
    for (number, camera) in model.cameras.iter().enumerate() {
        out!("    {} ({})", escape(&model.camera_key(number)), camera.lens);
    }
    out!("  animations  {}", named(&model.contents.animations));
    for (number, clip) in model.motion.clips.iter().enumerate() {
        let name = if clip.name.is_empty() { number.to_string() } else { escape(&clip.name) };
        let switches = match clip.switched_nodes() {
            0 => String::new(),
            count => format!(", shows and hides {}", plural(count, "node")),
        };
        out!("    {name}: {:.3} s, {}{switches}", clip.duration_s, plural(clip.channels.len(), "channel"));
    }
    out!("  skins       {}", count(model.contents.skins));
    for skin in &model.motion.rig.skins {
        let name = if skin.name.is_empty() { format!("#{}", skin.index) } else { escape(&skin.name) };
        out!("    {name}: {}", plural(skin.joints.len(), "joint"));
    }
    out!("  targets     {}", named(&model.motion.target_names));
    let extensions = &model.contents.extensions;
    out!("  extensions  {}", if extensions.is_empty() { "none".to_owned() } else { escape(&extensions.join(", ")) });
    let [geometry, textures] = memory(model).map(|bytes| bytes as f64 / f64::from(1 << 20));
    out!("  memory      {:.1} MiB: geometry {geometry:.1}, textures {textures:.1}", geometry + textures);
    out!("  images      {}", count(model.images.len()));
    for (number, image) in model.images.iter().enumerate() {
        let (name, uses) = (escape(&image.name), uses(model, number).join(", "));
        let space = if is_srgb(model, number) { "sRGB" } else { "linear" };
        out!("    {:>5} x {:<5} {name}: {uses} ({} {space})", image.width, image.height, image.form);
    }
}

/// The number of nodes, and how many of them the file hides.
fn nodes(model: &Model) -> String {
    let [switched, left_out] = hidden_nodes(model);
    let mut text = model.nodes.len().to_string();
    if switched > 0 {
        text += &format!(", {switched} hidden until an animation shows {}", if switched == 1 { "it" } else { "them" });
    }
    if left_out > 0 {
        text += &format!(", {left_out} hidden and left out");
    }
    text
}

/// How many nodes hide themselves until a clip shows them, and how many are left out, since they or nodes above them are hidden in all clips.
fn hidden_nodes(model: &Model) -> [usize; 2] {
    let is_left_out = |at: usize| model.nodes.get(at).is_some_and(|node| node.is_hidden);
    let rig = model.motion.rig.nodes.iter().enumerate();
    [
        rig.filter(|(at, node)| node.is_hidden && !is_left_out(*at)).count(),
        model.nodes.iter().filter(|node| node.is_hidden).count(),
    ]
}

/// Bytes on the device: of vertices and indices, and of textures with their mip levels.
fn memory(model: &Model) -> [usize; 2] {
    let geometry = |primitive: &Primitive| size_of_val(&*primitive.vertices) + size_of_val(&*primitive.indices);
    let textures: u64 = texture_sources(model).into_iter().map(|source| source.bytes(model)).sum();
    [model.primitives.iter().map(geometry).sum(), textures as usize]
}

/// Gives each image the form that it takes on the device. Without a device, that is the form which every device has.
fn settle(model: &mut Model, device: Option<&str>) {
    let forms = texel_forms(device).unwrap_or_default();
    std::sync::Arc::make_mut(&mut model.images).iter_mut().for_each(|image| image.settle(&forms));
}

/// The texture slots of the materials that read an image, as `base color`.
fn uses(model: &Model, image: usize) -> Vec<String> {
    let reads = |material: &Material, slot: usize| {
        material.textures[slot].is_some_and(|used| model.textures[used.texture].image == image)
    };
    let slots = TEXTURES.iter().enumerate().filter(|(slot, _)| model.materials.iter().any(|m| reads(m, *slot)));
    slots.map(|(slot, _)| slot_name(slot)).collect()
}

/// Whether the device reads the colors of an image as sRGB.
fn is_srgb(model: &Model, image: usize) -> bool {
    texture_sources(model).into_iter().any(|source| source.is_srgb() && source.images().any(|used| used == image))
}

/// A count, and the names.
fn named(names: &[String]) -> String {
    let known: Vec<String> = names.iter().filter(|name| !name.is_empty()).map(|name| escape(name)).collect();
    if known.is_empty() { count(names.len()) } else { format!("{}: {}", names.len(), known.join(", ")) }
}

/// How many sets of texture coordinates the vertices have.
fn uv_sets(model: &Model) -> usize {
    let has = |set| usize::from(model.primitives.iter().any(|primitive| primitive.attributes & set != 0));
    has(ATTRIBUTE_UV0) + has(ATTRIBUTE_UV1)
}

fn count(number: usize) -> String {
    if number == 0 { "none".to_owned() } else { number.to_string() }
}

fn summary(model: &Model) -> serde_json::Value {
    let mut value = parts(model);
    if let Some(environment) = &model.environment {
        let ModelEnvironment { name, side, intensity, rotation, .. } = &**environment;
        value["environment"] =
            json!({ "name": name, "side": side, "intensity": intensity, "rotation": rotation.to_array() });
    }
    value
}

fn parts(model: &Model) -> serde_json::Value {
    let (vertices, indices) = counts(model);
    let [switched, left_out] = hidden_nodes(model);
    json!({
        "model": model.name,
        "scenes": model.contents.scenes.len(),
        "nodes": model.nodes.len(),
        "hidden_nodes": { "switched": switched, "left_out": left_out },
        "meshes": model.contents.meshes,
        "animations": model.contents.animations.len(),
        "clips": model.contents.animations,
        "extensions": model.contents.extensions,
        "skins": model.contents.skins,
        "motion": motion(model),
        "primitives": model.primitives.len(),
        "instances": model.instances.len(),
        "vertices": vertices,
        "indices": indices,
        "materials": materials(model),
        "images": model.images.iter().map(|i| format!("{} {}x{}", i.name, i.width, i.height)).collect::<Vec<_>>(),
        "textures": (0..model.images.len()).map(|image| uses(model, image)).collect::<Vec<_>>(),
        "forms": model.images.iter().map(|image| image.form.to_string()).collect::<Vec<_>>(),
        "srgb": (0..model.images.len()).map(|image| is_srgb(model, image)).collect::<Vec<_>>(),
        "uv_sets": uv_sets(model),
        "memory_bytes": memory(model).iter().sum::<usize>(),
        "lights": model.lights.len(),
        "variants": model.variants,
        "cameras": model.cameras.len(),
        "size_m": rounded(size(model)),
        "center_m": rounded(model.bounds.center()),
        "warnings": model.warnings,
    })
}

/// A count with its noun.
fn plural(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// The parts of a model that move: clips, skins, morph targets and cameras.
fn motion(model: &Model) -> serde_json::Value {
    let clip = |clip: &Clip| {
        json!({ "name": clip.name, "duration_s": clip.duration_s, "channels": clip.channels.len(),
            "switched_nodes": clip.switched_nodes() })
    };
    let skin = |skin: &Skin| json!({ "name": skin.name, "index": skin.index, "joints": skin.joints.len() });
    json!({
        "clips": model.motion.clips.iter().map(clip).collect::<Vec<_>>(),
        "skins": model.motion.rig.skins.iter().map(skin).collect::<Vec<_>>(),
        "targets": model.motion.target_names,
        "cameras": (0..model.cameras.len()).map(|camera| model.camera_key(camera)).collect::<Vec<_>>(),
    })
}

/// Vertices and indices of all instances.
fn counts(model: &Model) -> (usize, usize) {
    let placed = model.instances.iter().map(|instance| &model.primitives[instance.primitive]);
    placed.fold((0, 0), |(vertices, indices), p| (vertices + p.vertices.len(), indices + p.indices.len()))
}

/// Triangles of all instances; points and lines are not counted.
fn triangles(model: &Model) -> usize {
    let placed = model.instances.iter().map(|instance| &model.primitives[instance.primitive]);
    let triangles = |p: &Primitive| match p.topology {
        Topology::Triangles => p.indices.len() / 3,
        Topology::TriangleStrip | Topology::TriangleFan => p.indices.len().saturating_sub(2),
        Topology::Points | Topology::Lines | Topology::LineStrip => 0,
    };
    placed.map(triangles).sum()
}

/// Materials of the file, except glTF's default one.
fn materials(model: &Model) -> usize {
    model.materials.len().saturating_sub(1)
}

/// Lengths of the bounding box's edges, meters.
fn size(model: &Model) -> glam::Vec3 {
    if model.bounds.is_empty() { glam::Vec3::ZERO } else { model.bounds.max - model.bounds.min }
}

/// To the millimeter.
fn rounded(v: glam::Vec3) -> [f64; 3] {
    v.to_array().map(|c| (f64::from(c) * 1e3).round() / 1e3)
}
