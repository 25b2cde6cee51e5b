//! `specula render`: writes a picture, or a picture of every mode, and again at every save with `--watch`.

mod args;
mod each;
mod many;
mod warnings;
mod watch;

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use specula::events::{CompletedEvent, Event, ReloadEvent, emit, in_short};
use specula::gpu::Gpu;
use specula::headless::Headless;
use specula::message;
use specula::picture;
use specula::pipeline::{Outcome, Reload};
use specula::recovery::SessionState;
use specula::render::Capture;
use specula::settings::Settings;
use specula::shader::{Diagnostic, Mode};

use super::common::chosen_modes::Modes;
use super::common::{asserts, check_mode, check_out, check_validation, compiler};
use super::progress::Progress;
use super::{Failure, print_diagnostics, tell_left_out};
pub use args::Args;
use warnings::{Warnings, warn_of_not_finite};
use watch::{Changes, Watch};

/// Runs the command.
pub fn run(mut args: Args, start: Instant) -> Result<(), Failure> {
    let mut device = None;
    if args.each {
        return each::run(args, |args| draw(args, Instant::now(), &mut device));
    }
    draw(&mut args, start, &mut device)
}

/// Draws what the options name. `device` is opened once.
fn draw(args: &mut Args, start: Instant, device: &mut Option<Arc<Gpu>>) -> Result<(), Failure> {
    args.common.take_files(&mut args.models)?;
    let mut settings = args.common.settings()?;
    let modes = Modes::of(&mut settings.mode);
    if matches!(modes, Modes::Named(_)) && many::is_asked(args) {
        let message = "`--mode` takes one mode here; --sheet takes a list itself, as --sheet final,d";
        return Err(Failure::Usage(message.into()));
    }
    let all = modes == Modes::All;
    match many::is_asked(args) {
        true => many::check(args)?,
        false => check_out(&args.out)?,
    }
    args.check()?;
    let sequence = args.frames.sequence()?;
    if args.paths && !all {
        return Err(Failure::Usage("--paths adds modes to `--mode all`; a mode that is named needs no --paths".into()));
    }
    let source = args.common.source()?;
    // Start watching before reading any file, so that no save is missed in between.
    let mut watch = args.watch.then(|| Watch::new(&source)).transpose()?;
    let gpu = match device {
        Some(gpu) => gpu.clone(),
        None => device.insert(args.common.gpu()?).clone(),
    };
    let args = &*args;
    let progress = Progress::new(!args.common.emits());
    progress.say("compiling the shaders");
    let read = |settings: &mut Settings| {
        let model = args.common.model(args.models.model.as_deref())?;
        args.common.fit(&model, settings)?;
        Ok::<_, Failure>(model)
    };
    let (mut headless, reload) =
        Headless::start(&gpu, &compiler()?, source, settings.clone(), args.common.size(), read)?;
    headless.set_sequence(sequence);
    if let Some(watch) = &mut watch {
        watch.follow(&headless);
    }
    if !first_picture(&mut headless, reload, args, watch.as_mut(), &progress)? {
        return Ok(());
    }
    drop(progress);
    if settings.environment.is_lit() {
        emit(args.common.emits(), &Event::Bake(headless.bake_report()));
    }
    let mut warnings = Warnings::default();
    warnings.tell(&headless.shaders().warnings);
    match write(&mut headless, args, &modes) {
        Err(Failure::Shaders(diagnostics)) if watch.is_some() => {
            tell(args, &diagnostics);
            message::tell("no picture yet; waiting for the next save");
        }
        result => {
            result?;
            hint_at_frames(&headless, args)?;
            hint_at_background(&headless);
            note_limit(&headless)?;
            let is_left_out = |mode: &&Mode| all && !args.paths && mode.follows_paths();
            tell_left_out(headless.shaders().modes.iter().filter(is_left_out).count());
        }
    }
    warn_of_bakes(&headless);
    warn_of_not_finite(&mut headless, args);
    emit(args.common.emits(), &Event::Ready { device: &gpu.info().name, ms: start.elapsed().as_secs_f64() * 1e3 });
    complete(&mut headless, args, watch.is_some())?;
    warnings.tell(&headless.shaders().warnings);
    let mut asserted = asserts::check(&mut headless, args.common.emits());
    if let Some(mut watch) = watch {
        // A save may mend it.
        go_on(std::mem::replace(&mut asserted, Ok(())))?;
        message::tell(format_args!("wrote {}; watching, Ctrl+C ends", args.out.display()));
        while let Some(changes) = watch.next() {
            again(&mut headless, args, &modes, &mut watch, &changes, &mut warnings)?;
            check_validation(&gpu)?;
        }
    }
    // Validation messages of the teardown count too.
    drop(headless);
    check_validation(&gpu)?;
    asserted
}

/// A result without failures that were printed, which do not end a command that watches.
fn go_on(result: Result<(), Failure>) -> Result<(), Failure> {
    match result {
        Err(Failure::Printed) => Ok(()),
        result => result,
    }
}

/// Creates what the first frame needs. If the shaders have failed and are watched, waits for the next save. Returns `false` if
/// watching has ended before.
fn first_picture(
    headless: &mut Headless,
    mut reload: Reload,
    args: &Args,
    watch: Option<&mut Watch>,
    progress: &Progress,
) -> Result<bool, Failure> {
    if let Some(watch) = watch {
        while let Outcome::Failed(diagnostics) = &reload.outcome {
            progress.pause();
            tell(args, diagnostics);
            message::tell("no picture yet; waiting for the next save");
            let Some(changes) = watch.next() else { return Ok(false) };
            take_files(headless, args, watch, &changes)?;
            reload = headless.update_first(headless.reloader().library().change_of(&changes.paths));
        }
    }
    match reload.outcome {
        Outcome::Failed(diagnostics) => Err(Failure::Shaders(diagnostics)),
        Outcome::Ready(_) | Outcome::Unchanged { .. } => {
            headless.check_settings()?;
            progress.say("baking the environment and building pipelines");
            headless.provide()?;
            Ok(true)
        }
    }
}

/// Handles a batch of changes, and writes the picture again if it may have changed.
fn again(
    headless: &mut Headless,
    args: &Args,
    modes: &Modes,
    watch: &mut Watch,
    changes: &Changes,
    warnings: &mut Warnings,
) -> Result<(), Failure> {
    let detect_ms = changes.first_event.elapsed().as_secs_f64() * 1e3;
    let new_files = take_files(headless, args, watch, changes)?;
    let known: BTreeSet<String> = headless.shaders().stages.keys().cloned().collect();
    let mut reload = headless.update_first(headless.reloader().library().change_of(&changes.paths));
    // A changed text may name other files.
    watch.follow(headless);
    // The picture may read a pass that is new.
    if headless.shaders().pending.iter().any(|stage| !known.contains(stage)) {
        complete(headless, args, true)?;
    }
    // A file that no stage depended on before.
    if reload.report.changed.is_empty() {
        let there = changes.paths.iter().filter(|path| path.exists());
        reload.report.changed = there.map(|path| path.display().to_string()).collect();
    }
    let mut first_frame_ms = 0.0;
    if new_files || matches!(reload.outcome, Outcome::Ready(_)) {
        let begin = Instant::now();
        let drawn = headless.draw().map_err(Failure::from);
        first_frame_ms = begin.elapsed().as_secs_f64() * 1e3;
        // Continue after a wrong value, mode or folder, since the next edit may correct it.
        match drawn.and_then(|()| write(headless, args, modes)) {
            Err(Failure::Input(message) | Failure::Usage(message)) => message::tell(message),
            // A loop that does not end.
            Err(Failure::Shaders(diagnostics)) => {
                tell(args, &diagnostics);
                message::tell("the last good picture stays");
            }
            result => {
                result?;
                note_limit(headless)?;
            }
        }
        warn_of_bakes(headless);
        warn_of_not_finite(headless, args);
    }
    if let Outcome::Ready(set) = &reload.outcome {
        warnings.tell(&set.shaders.warnings);
    }
    report(&reload, headless, args, detect_ms, first_frame_ms);
    complete(headless, args, true)?;
    warnings.tell(&headless.shaders().warnings);
    match reload.outcome {
        Outcome::Ready(_) => go_on(asserts::check(headless, args.common.emits())),
        _ => Ok(()),
    }
}

/// Compiles the stages that the picture did not need. Their errors end the command, unless it watches for the next save.
fn complete(headless: &mut Headless, args: &Args, watches: bool) -> Result<(), Failure> {
    let Some(rest) = headless.finish() else { return Ok(()) };
    if let Outcome::Failed(diagnostics) = &rest.outcome {
        if !watches {
            return Err(Failure::Shaders(diagnostics.clone()));
        }
        tell(args, diagnostics);
        message::tell("the picture is good; modes of the broken files are missing");
    }
    let generation = headless.shaders().generation;
    emit(args.common.emits(), &Event::Completed(CompletedEvent::new(&rest, generation)));
    Ok(())
}

/// Handles changed files of the model, environment and measured BRDF. Returns whether the picture may have changed. On failure
/// the last good one of each stays.
fn take_files(headless: &mut Headless, args: &Args, watch: &mut Watch, changes: &Changes) -> Result<bool, Failure> {
    let new_model = changes.model && take_model(headless, args, watch)?;
    if changes.measured {
        headless.measured_changed();
    }
    if changes.environment {
        headless.environment_changed();
    }
    let baked = changes.environment && take_environment(headless, args);
    Ok(new_model || baked || changes.measured)
}

/// Loads the model again. On failure the last good model stays.
fn take_model(headless: &mut Headless, args: &Args, watch: &mut Watch) -> Result<bool, Failure> {
    let loaded = args
        .common
        .model(args.models.model.as_deref())
        .and_then(|model| headless.set_model(model).map_err(Failure::from));
    match loaded {
        Ok(()) => {
            watch.follow(headless);
            message::tell("the model was loaded again");
            Ok(true)
        }
        Err(Failure::Input(message) | Failure::Usage(message)) => {
            message::tell(format_args!("{message}\nspecula: the last good model stays"));
            Ok(false)
        }
        Err(other) => Err(other),
    }
}

/// Bakes the environment again. On failure the last good environment stays.
fn take_environment(headless: &mut Headless, args: &Args) -> bool {
    let baked = headless.bake(true);
    match &baked {
        Ok(()) => emit(args.common.emits(), &Event::Bake(headless.bake_report())),
        Err(error) => message::tell(format_args!("{error}\nspecula: the last good environment stays")),
    }
    baked.is_ok()
}

/// Says that passes continue from frame to frame, if the number of frames was not given.
fn hint_at_frames(headless: &Headless, args: &Args) -> Result<(), Failure> {
    let passes: Vec<String> = headless.continuing_passes()?.iter().map(|name| format!("`{name}`")).collect();
    let subject = match passes.as_slice() {
        [one] => format!("the pass {one} continues"),
        all => format!("the passes {} continue", all.join(", ")),
    };
    if args.frames.frames.is_none() && !passes.is_empty() {
        message::tell(format_args!("hint: {subject} from frame to frame, and this is the first; --frames 60 draws 60"));
    }
    Ok(())
}

/// Says that the author's own background is not shown.
fn hint_at_background(headless: &Headless) {
    if let Some(file) = headless.hidden_background() {
        message::tell(format_args!("hint: {file} changes the background, which `--background env` shows"));
    }
}

/// Says what the picture cannot show as it is.
fn note_limit(headless: &Headless) -> Result<(), Failure> {
    if let Some(limit) = headless.frame_state()?.pipelines.limit() {
        message::tell(format_args!("note: {limit}"));
    }
    Ok(())
}

/// Warns of an environment that is not shown as its file has it, and of functions of the BRDF whose values the tables or the prefilter could not use.
fn warn_of_bakes(headless: &Headless) {
    for warning in headless.bake_warnings() {
        message::tell(format_args!("warning: {warning}"));
    }
}

fn tell(args: &Args, diagnostics: &[Diagnostic]) {
    print_diagnostics(diagnostics);
    for diagnostic in diagnostics {
        emit(args.common.emits(), &Event::Diagnostic(diagnostic));
    }
}

fn report(reload: &Reload, headless: &Headless, args: &Args, detect_ms: f64, first_frame_ms: f64) {
    let shaders = headless.shaders();
    match &reload.outcome {
        Outcome::Unchanged { cleared: false } => return,
        Outcome::Unchanged { cleared: true } => message::tell("the shaders are good again"),
        Outcome::Failed(diagnostics) => {
            tell(args, diagnostics);
            message::tell("the last good picture stays");
        }
        Outcome::Ready(_) => {
            let report = &reload.report;
            let changed = if report.changed.is_empty() { "removed file".to_owned() } else { report.changed.join(" ") };
            message::tell(format_args!(
                "{changed} -> {}  compile {:.0} ms + pipeline {:.0} ms + frame {first_frame_ms:.0} ms",
                in_short(&report.stages.iter().map(|(stage, _)| shaders.name_of(stage).to_owned()).collect::<Vec<_>>()),
                report.compile_ms,
                reload.pipeline_ms,
            ));
        }
    }
    let generation = shaders.generation;
    emit(args.common.emits(), &Event::Reload(ReloadEvent::new(reload, generation, detect_ms, first_frame_ms)));
}

/// Writes the picture, or a picture of each mode.
fn write(headless: &mut Headless, args: &Args, modes: &Modes) -> Result<(), Failure> {
    let out = args.out.as_path();
    if many::is_asked(args) {
        return many::write(headless, args);
    }
    if *modes == Modes::One {
        let slug = headless.settings_mut().mode.clone();
        check_mode(&headless.shaders(), &slug)?;
        headless.set_last_picture(!args.watch);
        let capture = capture(headless, args, &Progress::new(!args.common.emits()), (0, 1))?;
        if let Some(why) = headless.unseen_model(&capture)? {
            message::tell(format_args!("note: nothing of the model is in the picture: {why}"));
        }
        return write_picture(headless, args, &capture, out);
    }
    let progress = Progress::new(!args.common.emits());
    progress.say("compiling all modes");
    // The passes that are off, and their modes, are known when all stages have compiled.
    if let Some(Outcome::Failed(diagnostics)) = headless.finish().map(|rest| rest.outcome) {
        return Err(Failure::Shaders(diagnostics));
    }
    let frames = headless.settings_mut().view.frames;
    let shaders = headless.shaders();
    let written = modes.in_shaders(&shaders, args.paths)?;
    for (number, mode) in written.iter().enumerate() {
        let settings = headless.settings_mut();
        settings.mode.clone_from(&mode.slug);
        // A frame of a mode that traces the model takes seconds on a software device.
        settings.view.frames = if mode.traces && *modes == Modes::All { 1 } else { frames };
        let capture = capture(headless, args, &progress, (number, written.len()))?;
        let path = picture::path_of_mode(out, &mode.slug);
        write_picture(headless, args, &capture, &path)?;
    }
    headless.settings_mut().view.frames = frames;
    Ok(())
}

/// Writes a picture with its settings, the model and the shader tree.
fn write_picture(headless: &mut Headless, args: &Args, capture: &Capture, out: &Path) -> Result<(), Failure> {
    let work = SessionState {
        settings: headless.session().shared_settings(),
        model: args.models.model.clone(),
        scene: args.common.load_options().scene,
        tree: args.common.source()?.location().map(Path::to_owned),
    };
    picture::write(capture, &work, out).map_err(Failure::Input)
}

/// Renders the picture, which is one of several (its number from 0, and their count), and reports the number of random paths behind
/// it, if there are any.
fn capture(
    headless: &mut Headless,
    args: &Args,
    progress: &Progress,
    place: (usize, usize),
) -> Result<Capture, Failure> {
    let begin = Instant::now();
    progress.begin("picture", place, &headless.settings_mut().mode);
    headless.set_linear(picture::holds_light(&args.out));
    let capture = headless.render_with(|step| progress.step(step))?;
    tell(args, &headless.take_cut_short());
    if let Some(paths_per_pixel) = headless.paths_per_pixel()? {
        let ms = begin.elapsed().as_secs_f64() * 1e3;
        let mode = headless.settings_mut().mode.clone();
        message::tell(format_args!("{mode}: {paths_per_pixel} paths per pixel in {:.1} s (view.frames)", ms * 1e-3));
        emit(args.common.emits(), &Event::Paths { mode: &mode, paths_per_pixel, ms });
    }
    Ok(capture)
}
