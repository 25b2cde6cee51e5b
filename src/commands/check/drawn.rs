//! `specula check MODEL`: draws a model with stages that find assertions that fail, and operations whose result GLSL leaves open.

use std::collections::BTreeSet;

use serde_json::{Value, json};
use specula::events::{Event, emit};
use specula::message::{grouped, tell};
use specula::shader::Diagnostic;
use specula::shader::checks::Broken;

use super::args::Args;
use crate::commands::common::chosen_modes::Modes;
use crate::commands::common::opened::Opened;
use crate::commands::common::unchecked::warn_of_unchecked;
use crate::commands::common::{check_mode, check_validation};
use crate::commands::{Failure, print_diagnostics, print_json};

/// Something that was found, and the modes in which it did, the first one first.
struct Found {
    broken: Broken,
    diagnostic: Diagnostic,
    modes: Vec<String>,
}

/// Runs the command.
pub(super) fn run(args: &mut Args) -> Result<(), Failure> {
    args.common.take_files(&mut args.models)?;
    let mut settings = args.common.settings()?;
    // Each sample would run the stage again.
    settings.view.msaa = 1;
    let modes = Modes::of(&mut settings.mode);
    let sequence = args.frames.sequence()?;
    let first = settings.mode.clone();
    let Opened { gpu, mut headless, progress } = Opened::new(&args.common, &args.models, settings, sequence)?;
    let shaders = headless.shaders();
    check_mode(&shaders, &first)?;
    let slugs: Vec<String> = match &modes {
        Modes::One => vec![first],
        modes => modes.in_shaders(&shaders, args.paths)?.into_iter().map(|mode| mode.slug.clone()).collect(),
    };
    let (mut found, mut checks, mut left_out) = (Vec::<Found>::new(), 0, BTreeSet::new());
    let (mut dropped, mut without_derivatives, mut baked) = (0, false, Vec::new());
    for slug in &slugs {
        progress.say(&format!("checking the mode {slug}"));
        headless.settings_mut().mode.clone_from(slug);
        let picture = headless.check_operations(args.undefined)?;
        checks = checks.max(picture.checks);
        left_out.extend(picture.left_out);
        baked = picture.baked;
        dropped = dropped.max(picture.dropped);
        without_derivatives |= picture.without_derivatives;
        picture.broken.into_iter().for_each(|(broken, diagnostic)| add(&mut found, broken, diagnostic, slug));
    }
    drop(progress);
    print_diagnostics(&baked);
    warn_of_unchecked(&gpu.info().name, &left_out, (dropped, without_derivatives));
    found.sort_by(|a, b| (&a.broken.file, a.broken.line).cmp(&(&b.broken.file, b.broken.line)));
    let result = tell_of(args, &found, (checks, slugs.len()));
    drop(headless);
    check_validation(&gpu)?;
    result
}

/// Adds something that was found, or a mode to what is known.
fn add(found: &mut Vec<Found>, broken: Broken, diagnostic: Diagnostic, mode: &str) {
    let is_same = |known: &&mut Found| {
        let (a, b) = (&known.broken, &broken);
        let is_alike = (&a.file, a.line, a.rule, &a.text) == (&b.file, b.line, b.rule, &b.text);
        // A line may have several in one stage, and its file may be in several stages.
        is_alike && (a.stage != b.stage || a.key.1 == b.key.1)
    };
    match found.iter_mut().find(is_same) {
        Some(known) if known.modes.last().is_some_and(|last| last == mode) => {}
        Some(known) => known.modes.push(mode.to_owned()),
        None => found.push(Found { broken, diagnostic, modes: vec![mode.to_owned()] }),
    }
}

fn tell_of(args: &Args, found: &[Found], (checks, modes): (usize, usize)) -> Result<(), Failure> {
    let diagnostics: Vec<Diagnostic> = found.iter().map(with_modes).collect();
    for diagnostic in &diagnostics {
        emit(args.common.emits(), &Event::Diagnostic(diagnostic));
    }
    if args.json {
        print_json(&found.iter().map(as_json).collect::<Vec<_>>());
    }
    print_diagnostics(&diagnostics);
    let faults = found.iter().filter(|found| found.broken.is_fault()).count();
    if faults > 0 {
        tell(format_args!("{faults} error{}", if faults == 1 { "" } else { "s" }));
        return Err(Failure::Printed);
    }
    if !args.json && !args.common.emits() {
        let modes = if modes == 1 { "one mode".to_owned() } else { format!("{modes} modes") };
        let (of, none) = match args.undefined {
            true => ("assertions and operations", "none failed or was undefined"),
            false => ("assertions", "none failed"),
        };
        out!("drew {modes} with {} {of}: {none}", grouped(checks as f64));
    }
    Ok(())
}

fn with_modes(found: &Found) -> Diagnostic {
    let others = found.modes.len() - 1;
    let mode = &found.modes[0];
    let note = match others {
        0 => format!("in the mode {mode}"),
        1..=4 => format!("in the modes {}", found.modes.join(", ")),
        _ => format!("in the mode {mode} and {others} others"),
    };
    let mut diagnostic = found.diagnostic.clone();
    diagnostic.notes.push(note);
    diagnostic
}

fn as_json(found: &Found) -> Value {
    let mut json = found.broken.json(&found.diagnostic);
    json["modes"] = json!(found.modes);
    json
}
