//! `specula render`: a picture, or one of every mode, in a file; again at every save with `--watch`.

use std::path::PathBuf;
use std::time::Instant;

use specula::events::{Event, emit};
use specula::headless::{Headless, HeadlessError};
use specula::message;
use specula::picture;
use specula::render::{Outcome, Reload};
use specula::shader::Diagnostic;

use super::common::{Common, check_mode, check_out, check_validation, compiler};
use super::watch::{Changes, Watch};
use super::{Failure, print_diagnostics};

/// Options of `render`.
#[derive(clap::Args)]
pub struct Args {
    /// glTF model, .gltf or .glb, or the name of a built-in one [default: shader-ball]
    model: Option<PathBuf>,
    /// File to write, .png or .exr (raw values); with `--mode all`, FILE.<mode>.png for each
    #[arg(long, short, value_name = "FILE", default_value = "specula.png")]
    out: PathBuf,
    /// Stay, and render again whenever a shader or the model is saved
    #[arg(long)]
    watch: bool,
    #[command(flatten)]
    common: Common,
}

/// Runs the command.
pub fn run(args: Args, start: Instant) -> Result<(), Failure> {
    let mut settings = args.common.settings()?;
    let all = settings.mode == "all";
    if all {
        "final".clone_into(&mut settings.mode);
    }
    check_out(&args.out)?;
    let source = args.common.source()?;
    // Watching starts before anything is read, so that no save falls between.
    let mut watch = args.watch.then(|| Watch::new(&source)).transpose()?;
    let gpu = args.common.gpu()?;
    let mut model = args.common.model(args.model.as_deref())?;
    if let Some(watch) = &mut watch {
        watch.follow(&model, &[]);
    }
    let opened = loop {
        let opened =
            Headless::new(&gpu, &compiler()?, source.clone(), model.clone(), settings.clone(), args.common.size);
        match (opened, &mut watch) {
            (Err(HeadlessError::Shaders(diagnostics)), Some(watch)) => {
                tell(&args, &diagnostics);
                eprintln!("specula: no picture yet; waiting for the next save");
                match watch.next() {
                    Some(changes) if changes.model => model = args.common.model(args.model.as_deref())?,
                    Some(_) => {}
                    None => return Ok(()),
                }
            }
            (opened, _) => break opened?,
        }
    };
    let (mut headless, _) = opened;
    if let Some(watch) = &mut watch {
        watch.follow(headless.model(), headless.environment_files());
    }
    if settings.environment.is_lit() {
        emit(args.common.emits(), &Event::Bake(headless.bake_report()));
    }
    write(&mut headless, &args, all)?;
    emit(args.common.emits(), &Event::Ready { device: &gpu.info().name, ms: start.elapsed().as_secs_f64() * 1e3 });
    if let Some(mut watch) = watch {
        eprintln!("specula: wrote {}; watching, Ctrl+C ends", args.out.display());
        while let Some(changes) = watch.next() {
            again(&mut headless, &args, all, &mut watch, &changes)?;
            check_validation(&gpu)?;
        }
    }
    // What the layers find at the end counts too.
    drop(headless);
    check_validation(&gpu)
}

/// Takes a batch of changes in and writes the picture again when anything in it has changed.
fn again(headless: &mut Headless, args: &Args, all: bool, watch: &mut Watch, changes: &Changes) -> Result<(), Failure> {
    let detect_ms = changes.first_event.elapsed().as_secs_f64() * 1e3;
    let new_model = changes.model && take_model(headless, args, watch)?;
    let new_environment = changes.environment && take_environment(headless, args);
    let change = headless.reloader().library().change_of(&changes.paths);
    let reload = headless.update(change);
    let mut first_frame_ms = 0.0;
    if new_model || new_environment || matches!(reload.outcome, Outcome::Ready(_)) {
        let begin = Instant::now();
        let drawn = headless.draw().map_err(Failure::from);
        first_frame_ms = begin.elapsed().as_secs_f64() * 1e3;
        // A value, a mode or a place that this edit made wrong may be right after the next.
        match drawn.and_then(|()| write(headless, args, all)) {
            Err(Failure::Input(message) | Failure::Usage(message)) => message::tell(message),
            result => result?,
        }
    }
    report(&reload, headless, args, detect_ms, first_frame_ms);
    Ok(())
}

/// Loads the model again; on failure the last good one stays.
fn take_model(headless: &mut Headless, args: &Args, watch: &mut Watch) -> Result<bool, Failure> {
    let loaded = args.common.model(args.model.as_deref()).and_then(|model| {
        watch.follow(&model, headless.environment_files());
        headless.set_model(model).map_err(Failure::from)
    });
    match loaded {
        Ok(()) => {
            eprintln!("specula: the model was loaded again");
            Ok(true)
        }
        Err(Failure::Input(message) | Failure::Usage(message)) => {
            message::tell(format_args!("{message}\nspecula: the last good model stays"));
            Ok(false)
        }
        Err(other) => Err(other),
    }
}

/// Bakes the environment again; on failure the last good one stays.
fn take_environment(headless: &mut Headless, args: &Args) -> bool {
    let baked = headless.bake(true);
    match &baked {
        Ok(()) => emit(args.common.emits(), &Event::Bake(headless.bake_report())),
        Err(error) => message::tell(format_args!("{error}\nspecula: the last good environment stays")),
    }
    baked.is_ok()
}

fn tell(args: &Args, diagnostics: &[Diagnostic]) {
    print_diagnostics(diagnostics);
    for diagnostic in diagnostics {
        emit(args.common.emits(), &Event::Diagnostic(diagnostic));
    }
}

fn report(reload: &Reload, headless: &Headless, args: &Args, detect_ms: f64, first_frame_ms: f64) {
    match &reload.outcome {
        Outcome::Unchanged { cleared: false } => return,
        Outcome::Unchanged { cleared: true } => eprintln!("specula: the shaders are good again"),
        Outcome::Failed(diagnostics) => {
            tell(args, diagnostics);
            eprintln!("specula: the last good picture stays");
        }
        Outcome::Ready(set) => {
            print_diagnostics(&set.shaders.warnings);
            let report = &reload.report;
            message::tell(format_args!(
                "{} -> {}  compile {:.0} ms + pipeline {:.0} ms + frame {first_frame_ms:.0} ms",
                report.changed.join(" "),
                report.stages.iter().map(|(stage, _)| stage.as_str()).collect::<Vec<_>>().join(" "),
                report.compile_ms,
                reload.pipeline_ms,
            ));
        }
    }
    let generation = headless.pipelines().shaders.generation;
    emit(args.common.emits(), &Event::Reload(reload.event(generation, detect_ms, first_frame_ms)));
}

/// Writes the picture, or one of each mode.
fn write(headless: &mut Headless, args: &Args, all: bool) -> Result<(), Failure> {
    let out = args.out.as_path();
    if !all {
        let slug = headless.settings_mut().mode.clone();
        check_mode(&headless.pipelines().shaders, &slug)?;
        let capture = headless.render()?;
        return picture::write(&capture, out).map_err(Failure::Input);
    }
    let slugs: Vec<String> = headless.pipelines().shaders.modes.iter().map(|m| m.slug.clone()).collect();
    for slug in slugs {
        let path = picture::path_of_mode(out, &slug);
        headless.settings_mut().mode = slug;
        let capture = headless.render()?;
        picture::write(&capture, &path).map_err(Failure::Input)?;
    }
    Ok(())
}
