//! `specula bench passes`: what declared passes cost a frame.

use std::time::Instant;

use serde_json::{Value, json};
use specula::headless::Headless;
use specula::scene::Model;
use specula::settings::Settings;
use specula::shader::Source;

use super::context::Bench;
use super::folder::{TempFolder, copy_tree};
use super::samples::{ms, round, summary};
use crate::commands::Failure;

/// The passes that the picture is drawn with, as `--set` takes them.
const WITH: [&str; 3] = ["SHADOWS=Hard", "AMBIENT_OCCLUSION=true", "BLOOM=true"];
/// Passes of one pixel in the chain, whose cost is only their bookkeeping.
const MANY: usize = 100;

/// Times frames in turn: with the current settings, with [`WITH`], and with [`MANY`] passes of one pixel that read each other.
pub(super) fn passes(bench: &Bench<'_>) -> Result<Value, Failure> {
    let args = bench.args;
    let folder = TempFolder::new()?;
    copy_tree(&args.common.source()?, &folder.0)?;
    for index in 0..MANY {
        let path = folder.0.join(format!("passes/chain_{index}.frag"));
        std::fs::write(path, pass_of_chain(index)).map_err(|e| Failure::Input(e.to_string()))?;
    }
    let (model, settings) = (bench.model()?, args.common.settings()?);
    let mut more = settings.clone();
    WITH.iter().try_for_each(|set| more.assign(set)).map_err(Failure::Usage)?;
    let renderer = |source: Source, settings: Settings, model: Model| -> Result<Headless, Failure> {
        let mut headless = bench.renderer(source, settings, model)?;
        headless.draw()?;
        Ok(headless)
    };
    let mut renderers = [
        renderer(args.common.source()?, settings.clone(), model.clone())?,
        renderer(args.common.source()?, more, model.clone())?,
        renderer(Source::disk(folder.0.clone()), settings, model)?,
    ];
    let mut samples: [Vec<f64>; 3] = Default::default();
    // Wall time minus device time; empty on a device that does not measure.
    let mut cpu: [Vec<f64>; 3] = Default::default();
    for _ in bench.samples() {
        for ((headless, list), cpu) in renderers.iter_mut().zip(&mut samples).zip(&mut cpu) {
            headless.settings_mut().camera.azimuth += 0.001;
            let begin = Instant::now();
            headless.draw()?;
            list.push(ms(begin));
            cpu.extend(headless.device_ms().map(|device_ms| ms(begin) - device_ms));
        }
    }
    let least = |list: &Vec<f64>| list.iter().copied().fold(f64::INFINITY, f64::min);
    let ([plain, with, many], [cpu, _, cpu_many]) = (samples.each_ref().map(least), cpu.each_ref().map(least));
    let [frame, with_passes, with_many] = samples.map(summary);
    Ok(json!({
        "size": [args.common.size().0, args.common.size().1],
        "with": WITH.join(" "),
        "frame_ms": frame,
        "with_passes_ms": with_passes,
        "with_100_small_passes_ms": with_many,
        "times": round(with / plain),
        "100_small_passes_ms": round(many - plain),
        "100_small_passes_cpu_ms": (cpu.is_finite() && cpu_many.is_finite()).then(|| round(cpu_many - cpu)),
    }))
}

/// The text of a pass of one pixel that reads the previous pass. The last one draws to the picture.
fn pass_of_chain(index: usize) -> String {
    let read = index.checked_sub(1).map_or("depth".to_owned(), |before| format!("chain_{before}"));
    let (options, picture, add) = match index + 1 == MANY {
        true => ("to=picture", "uniform sampler2D picture;\n", "texture(picture, uv) + 1e-9 * "),
        false => ("size=1x1", "", ""),
    };
    format!(
        "//@pass chain_{index} {options}\n#version 460\n#include \"pass.glsl\"\n{picture}uniform sampler2D {read};\n\
         void main() {{ color = {add}texture({read}, vec2(0.5)); }}\n"
    )
}
