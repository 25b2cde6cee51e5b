//! `specula info`: the devices, a model, the shader tree.

use std::path::PathBuf;

use serde_json::json;
use specula::gpu::adapters;
use specula::scene::Model;

use super::Failure;
use super::common::Common;

/// Options of `info`.
#[derive(clap::Args)]
pub struct Args {
    /// glTF model to tell about [default: the built-in shader ball]
    model: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    common: Common,
}

/// Runs the command. A machine without Vulkan is told about too.
pub fn run(args: &Args) -> Result<(), Failure> {
    let devices = adapters();
    let model = args.common.model(args.model.as_deref())?;
    let source = args.common.source()?;
    let tree = source.root().map_or_else(|| "built in".to_owned(), |root| root.display().to_string());
    if args.json {
        let (devices, why_none) = devices.map_or_else(|e| (Vec::new(), Some(e.to_string())), |d| (d, None));
        let value = json!({ "version": env!("CARGO_PKG_VERSION"), "devices": devices, "why_no_device": why_none, "shaders": tree,
            "model": summary(&model) });
        out!("{value:#}");
        return Ok(());
    }
    out!("specula {}", env!("CARGO_PKG_VERSION"));
    out!("shaders    {tree}");
    match devices {
        Ok(devices) => {
            for device in devices {
                let note = device.refused.map(|why| format!("  (not usable: {why})")).unwrap_or_default();
                out!("device     {} ({}), Vulkan {}, {}{note}", device.name, device.kind, device.api, device.driver);
            }
        }
        Err(error) => out!("device     none: {error}"),
    }
    for (key, value) in summary(&model).as_object().into_iter().flatten() {
        let text = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        out!("{:10} {text}", key.replace('_', " "));
    }
    Ok(())
}

fn summary(model: &Model) -> serde_json::Value {
    let placed = model.instances.iter().map(|i| &model.primitives[i.primitive]);
    let (mut vertices, mut indices) = (0, 0);
    for primitive in placed {
        vertices += primitive.vertices.len();
        indices += primitive.indices.len();
    }
    let size = if model.bounds.is_empty() { glam::Vec3::ZERO } else { model.bounds.max - model.bounds.min };
    json!({
        "model": model.name,
        "primitives": model.primitives.len(),
        "instances": model.instances.len(),
        "vertices": vertices,
        "indices": indices,
        "materials": model.materials.len().saturating_sub(1), // without the loader's own
        "images": model.images.iter().map(|i| format!("{} {}x{}", i.name, i.width, i.height)).collect::<Vec<_>>(),
        "lights": model.lights.len(),
        "variants": model.variants,
        "cameras": model.cameras.len(),
        "size_m": rounded(size),
        "center_m": rounded(model.bounds.center()),
        "warnings": model.warnings,
    })
}

/// To the millimeter.
fn rounded(v: glam::Vec3) -> [f64; 3] {
    v.to_array().map(|c| (f64::from(c) * 1e3).round() / 1e3)
}
