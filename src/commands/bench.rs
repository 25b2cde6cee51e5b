//! `specula bench reload|frame|load|bake|thumbnails|passes|scale|trace|cost`: measures times on this machine, and prints them with the device's name.

mod args;
mod context;
mod cost;
mod edited;
mod edits;
mod folder;
mod passes;
mod samples;
mod scale;
mod trace;

use std::collections::BTreeMap;
use std::time::Instant;

use serde_json::{Value, json};
use specula::cpu_clock::CpuClock;
use specula::headless::Headless;
use specula::pipeline::Outcome;
use specula::scene::LoadTiming;
use specula::shader::{Source, TreePath};

use super::common::{check_validation, compiler};
use super::progress::Progress;
use super::{Failure, print_json};
pub use args::Args;
use args::What;
use context::Bench;
use edited::{edited, finish};
use samples::{ms, round, summary};

/// Width and height of a thumbnail, pixels.
const THUMBNAIL: [u32; 2] = [96, 72];

/// Runs the command.
pub fn run(mut args: Args, start: Instant) -> Result<(), Failure> {
    args.common.take_files(&mut args.models)?;
    let gpu = args.common.gpu_without_pipelines()?;
    let compiler = compiler()?;
    compiler.warm();
    let progress = Progress::new(!args.common.emits());
    progress.say("compiling the shaders");
    let bench = Bench { args: &args, gpu: &gpu, compiler: &compiler, progress: &progress };
    let mut result = match args.what {
        What::Reload if args.edits.is_some() => edits::edits(&bench)?,
        What::Reload => reload(&bench)?,
        What::Frame => frame(&bench)?,
        What::Load => load(&bench, start)?,
        What::Bake => bake(&bench)?,
        What::Passes => passes::passes(&bench)?,
        What::Thumbnails => thumbnails(&bench)?,
        What::Scale => scale::scale(&bench)?,
        What::Trace => trace::trace(&bench)?,
        What::Cost => cost::cost(&bench)?,
    };
    if matches!(args.what, What::Scale) {
        result["textures"] = json!(scale::textures::series(&bench)?);
    }
    drop(progress);
    result["device"] = json!(gpu.info().name);
    result["samples"] = json!(args.samples);
    match args.what {
        _ if args.json => print_json(&result),
        What::Cost => cost::print(&result),
        _ => print_table(&result),
    }
    check_validation(&gpu)
}

/// Saves an edited file in a copy of the tree, waits for the watcher, reloads and renders. Times every step, and what is
/// left to compile when the frame is on screen.
fn reload(bench: &Bench<'_>) -> Result<Value, Failure> {
    let args = bench.args;
    let (folder, _watcher, batches) = bench.watched_copy()?;
    let (model, mut settings) = (bench.model()?, args.common.settings()?);
    args.common.fit(&model, &mut settings)?;
    let mut headless = bench.renderer(Source::disk(folder.0.clone()), settings, model)?;
    headless.render()?;

    let path = folder.0.join(&args.edit);
    let original = std::fs::read_to_string(&path).map_err(|e| Failure::Input(format!("--edit {}: {e}", args.edit)))?;
    let used = TreePath::from(args.edit.as_str());
    let names = ["detect_ms", "compile_ms", "pipeline_ms", "first_frame_ms", "total_ms", "overhead_ms", "rest_ms"];
    let mut samples: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    for sample in bench.samples() {
        let text = edited(&original, sample + 1);
        let begin = Instant::now();
        std::fs::write(&path, text).map_err(|e| Failure::Input(e.to_string()))?;
        let batch = batches.recv().map_err(|e| Failure::Input(e.to_string()))?;
        let detect_ms = ms(begin);
        let library = headless.reloader().library();
        let (change, is_used) = (library.change_of(&batch.paths), library.dependencies().contains(&used));
        let reload = headless.update_first(change);
        match reload.outcome {
            Outcome::Ready(_) => {}
            Outcome::Failed(diagnostics) => return Err(Failure::Shaders(diagnostics)),
            // The compiler drops a function that nothing calls.
            Outcome::Unchanged { .. } if is_used => {}
            Outcome::Unchanged { .. } => return Err(Failure::Input(format!("no stage uses {}", args.edit))),
        }
        let frame = Instant::now();
        headless.draw()?;
        let (first_frame_ms, total_ms) = (ms(frame), ms(begin));
        let (compile_ms, pipeline_ms) = (reload.report.compile_ms, reload.pipeline_ms);
        let overhead_ms = total_ms - compile_ms - pipeline_ms - first_frame_ms;
        let rest = Instant::now();
        finish(&mut headless)?;
        let rest_ms = ms(rest);
        let values = [detect_ms, compile_ms, pipeline_ms, first_frame_ms, total_ms, overhead_ms, rest_ms];
        samples.iter_mut().zip(values).for_each(|(list, value)| list.push(value));
    }
    let table = names.iter().zip(samples).map(|(name, list)| ((*name).to_owned(), summary(list)));
    Ok(Value::Object(table.collect()))
}

/// Times frames of the selected mode, the CPU time of frames that do not change, and the first and second frame of every mode but
/// those of random paths, which take up to a minute on a software device.
fn frame(bench: &Bench<'_>) -> Result<Value, Failure> {
    let args = bench.args;
    let (source, settings) = (args.common.source()?, args.common.settings()?);
    let mut headless = bench.renderer(source, settings, bench.model()?)?;
    headless.draw()?;
    let (mut wall, mut device, mut passes) = (Vec::new(), Vec::new(), BTreeMap::<String, Vec<f64>>::new());
    for _ in bench.samples() {
        // A still picture is not drawn again, so measure one that turns, too slowly for it to change.
        headless.settings_mut().camera.azimuth += 0.001;
        let begin = Instant::now();
        headless.draw()?;
        wall.push(ms(begin));
        device.extend(headless.device_ms());
        for pass in headless.pass_times() {
            passes.entry(pass.name.clone()).or_default().push(pass.ms);
        }
    }
    let mut cpu = Vec::new();
    for _ in 0..args.samples {
        let clock = CpuClock::start();
        headless.draw()?;
        cpu.extend(clock.map(CpuClock::ms));
    }
    let passes: serde_json::Map<String, Value> = passes.into_iter().map(|(name, ms)| (name, summary(ms))).collect();
    // With --mode, skip the other modes.
    let slugs: Vec<String> = match args.common.mode.is_empty() {
        false => Vec::new(),
        true => {
            let modes = headless.shaders().modes.clone();
            modes.iter().filter(|mode| !mode.follows_paths()).map(|mode| mode.slug.clone()).collect()
        }
    };
    let (mut first, mut again, mut modes) = (Vec::new(), Vec::new(), Vec::new());
    for (index, slug) in slugs.iter().enumerate() {
        bench.progress.begin("mode", (index, slugs.len()), slug);
        headless.settings_mut().mode.clone_from(slug);
        let begin = Instant::now();
        headless.draw()?;
        let first_ms = ms(begin);
        let begin = Instant::now();
        headless.draw()?;
        let again_ms = ms(begin);
        first.push(first_ms);
        again.push(again_ms);
        modes.push(json!({ "slug": slug, "first_ms": round(first_ms), "again_ms": round(again_ms) }));
    }
    Ok(json!({
        "size": [args.common.size().0, args.common.size().1],
        "frame_ms": summary(wall),
        "device_ms": summary(device),
        "cpu_ms": summary(cpu),
        "passes": passes,
        "mode_first_ms": summary(first),
        "mode_again_ms": summary(again),
        "modes": modes,
    }))
}

/// Draws all thumbnails of the gallery.
fn thumbnails(bench: &Bench<'_>) -> Result<Value, Failure> {
    let args = bench.args;
    let (source, mut settings) = (args.common.source()?, args.common.settings()?);
    // As the window draws them.
    let is_cpu = bench.gpu.info().kind == "cpu";
    settings.view.msaa = if is_cpu { 1 } else { settings.view.msaa };
    let size = if is_cpu { THUMBNAIL.map(|side| 2 * side) } else { THUMBNAIL };
    let mut headless = bench.renderer(source, settings, bench.model()?)?;
    headless.draw()?;
    let modes = headless.shaders().modes.clone();
    bench.progress.say("drawing the thumbnails");
    let mut draw = || -> Result<(usize, f64), Failure> {
        let begin = Instant::now();
        let drawn = headless.thumbnails(size.into(), &modes)?.len();
        Ok((drawn, ms(begin)))
    };
    let (count, first) = draw()?;
    let again = (0..args.samples).map(|_| Ok(draw()?.1)).collect::<Result<Vec<f64>, Failure>>()?;
    Ok(json!({
        "size": size,
        "thumbnails": count,
        "first_ms": round(first),
        "again_ms": summary(again),
    }))
}

/// Loads the model repeatedly, while the shaders compile. Times the first load also from the start of the program.
fn load(bench: &Bench<'_>, start: Instant) -> Result<Value, Failure> {
    let args = bench.args;
    let device_ms = ms(start);
    let names = [
        "parse_ms",
        "decode_ms",
        "tangents_ms",
        "load_ms",
        "upload_ms",
        "compile_ms",
        "pipeline_ms",
        "first_frame_ms",
        "total_ms",
    ];
    let mut samples: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    let mut cold_ms = 0.0;
    for sample in bench.samples() {
        let begin = Instant::now();
        let (source, settings) = (args.common.source()?, args.common.settings()?);
        let (mut load_ms, mut timing) = (0.0, LoadTiming::default());
        let (mut headless, reload) =
            Headless::start(bench.gpu, bench.compiler, source, settings, args.common.size(), |settings| {
                let model = bench.model()?;
                args.common.fit(&model, settings)?;
                (load_ms, timing) = (ms(begin), model.timing);
                Ok::<_, Failure>(model)
            })?;
        if let Outcome::Failed(diagnostics) = reload.outcome {
            return Err(Failure::Shaders(diagnostics));
        }
        headless.check_settings()?;
        headless.provide()?;
        let frame = Instant::now();
        headless.draw()?;
        let (first_frame_ms, total_ms) = (ms(frame), ms(begin));
        if sample == 0 {
            cold_ms = device_ms + total_ms;
        }
        let values = [
            timing.parse_ms,
            timing.decode_ms,
            timing.tangents_ms,
            load_ms,
            headless.upload_ms(),
            reload.report.compile_ms,
            reload.pipeline_ms,
            first_frame_ms,
            total_ms,
        ];
        samples.iter_mut().zip(values).for_each(|(list, value)| list.push(value));
        finish(&mut headless)?;
    }
    let table = names.iter().zip(samples).map(|(name, list)| ((*name).to_owned(), summary(list)));
    let mut result = Value::Object(table.collect());
    result["start_to_device_ms"] = json!(round(device_ms));
    result["start_to_first_frame_ms"] = json!(round(cold_ms));
    Ok(result)
}

/// Bakes the selected environment repeatedly. The first bake includes the creation of its pipelines.
fn bake(bench: &Bench<'_>) -> Result<Value, Failure> {
    let args = bench.args;
    let (source, settings) = (args.common.source()?, args.common.settings()?);
    if !settings.environment.is_lit() {
        return Err(Failure::Usage(
            "--env none leaves no environment to bake; use --env studio, sky, furnace or a file".into(),
        ));
    }
    let mut headless = bench.renderer(source, settings, bench.model()?)?;
    let (mut table, mut from_disk) = (BTreeMap::<String, Vec<f64>>::new(), Vec::new());
    for _ in bench.samples() {
        headless.bake(false)?;
        let report = serde_json::to_value(headless.bake_report()).unwrap_or_default();
        for (name, value) in report.as_object().into_iter().flatten() {
            value.as_f64().into_iter().for_each(|ms| table.entry(name.clone()).or_default().push(ms));
        }
        headless.bake(true)?;
        from_disk.push(headless.bake_report().total_ms);
    }
    let mut result = Value::Object(table.into_iter().map(|(name, list)| (name, summary(list))).collect());
    result["from_disk_ms"] = summary(from_disk);
    result["environment"] = json!(headless.bake_report().environment);
    Ok(result)
}

fn print_table(result: &Value) {
    for (name, value) in result.as_object().into_iter().flatten() {
        match (value.get("min"), value.get("median"), value.get("p95")) {
            (Some(min), Some(median), Some(p95)) => {
                out!("{name:24} min {min:>10}   median {median:>10}   p95 {p95:>10}")
            }
            _ if value.is_array() && name == "modes" => {}
            _ if matches!(name.as_str(), "primitives" | "materials") => {
                for step in value.as_array().into_iter().flatten() {
                    let of = format!("{} primitives, {} materials", step["primitives"], step["materials"]);
                    out!("{of:34} cpu_ms min {:>10}   growth {:>8}", step["cpu_ms"]["min"], step["growth"]);
                }
            }
            _ if name == "joints" => {
                for step in value.as_array().into_iter().flatten() {
                    let of = format!("{} joints", step["joints"]);
                    out!("{of:34} cpu_ms min {:>10}   growth {:>8}", step["cpu_ms"]["min"], step["growth"]);
                }
            }
            _ if name == "passes" => {
                for (pass, ms) in value.as_object().into_iter().flatten() {
                    out!("{:24} median {:>10}", format!("  pass {pass}"), ms["median"]);
                }
            }
            _ => out!("{name:24} {value}"),
        }
    }
}
