//! `specula brdf split-sum`: compares the picture's image-based lighting with the same integral by random paths.

use std::path::Path;

use serde_json::json;
use specula::headless::Headless;
use specula::measure::Surface;
use specula::render::Capture;
use specula::report::{Lines, Report, Series};
use specula::scene::{self, LoadOptions};
use specula::settings::{LightSource, MaterialOverride};

use super::options::{Options, SurfaceOptions, title};
use crate::commands::common::names::check_environment;
use crate::commands::common::report::{check_report, write_report};
use crate::commands::common::{TIMEOUT_S, check_mode, check_validation, compiler, open_gpu, source};
use crate::commands::progress::Progress;
use crate::commands::{Failure, print_json};

/// The model whose sphere is measured.
const MODEL: &str = "material-override";
const SIDE: u32 = 64;
const ROWS: u32 = 10;
/// Least NoV of the compared pixels, at an angle of 84 degrees. At larger angles the triangles of the mesh are visible.
const LEAST_N_DOT_V: f32 = 0.1;

/// Options of `brdf split-sum`.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    surface: SurfaceOptions,
    /// Environment that lights the surface: studio, sky, furnace, or a .hdr or .exr file
    #[arg(long, value_name = "NAME|FILE", default_value = "studio")]
    env: String,
    /// Number of frames of random paths to average, 1 to 10000
    #[arg(long, value_name = "N", default_value_t = 64, allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    frames: u32,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    options: Options,
}

/// Difference between the split sum and the reference, relative to the mean of the reference. The picture is small: with a sun and a
/// smooth surface, the result depends on the few pixels of the highlight.
struct RoughnessRow {
    roughness: f32,
    /// Mean difference.
    bias: f64,
    /// Root mean square of the difference, including the reference's noise.
    rms: f64,
}

/// Runs the command.
pub fn run(args: &Args, progress: &Progress) -> Result<(), Failure> {
    let mut settings = args.options.settings()?;
    settings.lights.source = LightSource::None;
    settings.environment.name.clone_from(&args.env);
    settings.view.msaa = 1;
    settings.view.background = "none".into();
    settings.view.frames = args.frames;
    let metallic = args.surface.metallic.unwrap_or(1.0);
    let base_color = args.surface.base_color;
    settings.material = MaterialOverride { enabled: true, base_color, metallic, ..MaterialOverride::default() };
    settings.check().map_err(Failure::Usage)?;
    args.options.report.as_deref().map_or(Ok(()), check_report)?;
    check_environment(&args.env)?;
    if !settings.environment.is_lit() {
        return Err(Failure::Usage("split-sum needs an environment: use --env studio, sky, furnace or a file".into()));
    }

    let gpu = open_gpu(args.options.device.as_deref(), args.options.validate, TIMEOUT_S, None)?;
    let model = scene::open(Some(Path::new(MODEL)), &LoadOptions::default());
    let model = model.map_err(|e| Failure::Input(e.to_string()))?;
    let tree = source(args.options.shaders.as_deref())?;
    let (mut headless, _) = Headless::new(&gpu, &compiler()?, tree, model, settings, (SIDE, SIDE))?;
    for mode in ["n-dot-v", "final", "monte-carlo"] {
        check_mode(&headless.shaders(), mode)?;
    }
    let n_dot_v = capture(&mut headless, "n-dot-v")?;
    let mut rows = Vec::new();
    for row in 1..=ROWS {
        let roughness = row as f32 / ROWS as f32;
        progress.begin("roughness", (row as usize - 1, ROWS as usize), &format!("{roughness:.1}"));
        headless.settings_mut().material.roughness = roughness;
        let split_sum = capture(&mut headless, "final")?;
        let truth = capture(&mut headless, "monte-carlo")?;
        let row = compare(roughness, &split_sum, &truth, &n_dot_v);
        rows.push(row.ok_or_else(|| Failure::Input(format!("{} is black, so there is nothing to compare", args.env)))?);
    }
    if args.json {
        let list = rows.iter().map(|r| json!({ "roughness": r.roughness, "bias": r.bias, "rms": r.rms }));
        let list: Vec<_> = list.collect();
        let options = json!({ "environment": args.env, "metallic": metallic, "frames": args.frames });
        print_json(&json!({ "rows": list, "options": options }));
    } else {
        out!(
            "Error of the split sum in {}: split sum minus random paths ({} frames), relative to their mean",
            args.env,
            args.frames
        );
        out!("\nroughness     bias      rms");
        for row in &rows {
            out!("{:9.1}  {:+6.2} %  {:5.2} %", row.roughness, row.bias * 100.0, row.rms * 100.0);
        }
    }
    if let Some(path) = &args.options.report {
        write_report(path, &page(args, Surface { base_color, metallic }, &rows))?;
    }
    check_validation(&gpu)
}

/// The page of `--report`.
fn page(args: &Args, surface: Surface, rows: &[RoughnessRow]) -> Report {
    let mut report = Report::new(&format!("Split sum in {}", args.env));
    report.note(&format!(
        "{}. Split sum minus random paths ({} frames), relative to their mean: bias is the mean difference, rms its root mean square with the noise of the paths.",
        title(surface),
        args.frames
    ));
    let series = |name: &str, value: fn(&RoughnessRow) -> f64| Series {
        name: name.to_owned(),
        points: rows.iter().map(|row| (f64::from(row.roughness), 100.0 * value(row))).collect(),
    };
    report.lines(&Lines {
        title: "Error over roughness".to_owned(),
        x: "roughness".to_owned(),
        y: "error, percent".to_owned(),
        series: vec![series("bias", |row| row.bias), series("rms", |row| row.rms)],
        least: 1.0,
    });
    let row = |row: &RoughnessRow| {
        vec![
            format!("{:.1}", row.roughness),
            format!("{:+.2} %", 100.0 * row.bias),
            format!("{:.2} %", 100.0 * row.rms),
        ]
    };
    report.table("Values", &["roughness", "bias", "rms"], &rows.iter().map(row).collect::<Vec<_>>());
    report
}

fn capture(headless: &mut Headless, mode: &str) -> Result<Capture, Failure> {
    headless.settings_mut().mode = mode.into();
    Ok(headless.render()?)
}

fn compare(roughness: f32, split_sum: &Capture, truth: &Capture, n_dot_v: &Capture) -> Option<RoughnessRow> {
    let pixels = split_sum.raw.iter().zip(&truth.raw).zip(&n_dot_v.raw);
    let seen = pixels.filter(|(_, cosine)| cosine[3] == 1.0 && cosine[0] > LEAST_N_DOT_V);
    let (mut count, mut mean, mut bias, mut square) = (0.0, 0.0, 0.0, 0.0);
    for ((a, b), _) in seen {
        for (a, b) in a.iter().zip(b).take(3) {
            let (a, b) = (f64::from(*a), f64::from(*b));
            count += 1.0;
            mean += b;
            bias += a - b;
            square += (a - b) * (a - b);
        }
    }
    (mean > 0.0).then(|| RoughnessRow { roughness, bias: bias / mean, rms: (square / count).sqrt() * count / mean })
}
