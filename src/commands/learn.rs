//! `specula learn`: exercises, in the window or checked in a terminal.

use std::path::{Path, PathBuf};
use std::time::Instant;

use serde_json::json;
use specula::learn::{Exercise, Finding, GoalMeter, LearnError, Progress, exercises, find, prepare};
use specula::message::tell;
use specula::shader::{Source, is_specula_tree};

use super::common::{Common, check_validation, compiler};
use super::{Failure, print_json, view};

/// Where the folders of the exercises are, if nothing else is chosen.
const FOLDER: &str = "specula-learn";

/// Options of `learn`.
#[derive(clap::Args)]
pub struct Args {
    /// Number or name of an exercise to open [default: the first unsolved one]; or list, check or reset
    #[arg(value_name = "EXERCISE|list|check|reset")]
    what: Option<String>,
    /// Number or name of the exercise to check
    #[arg(value_name = "EXERCISE")]
    exercise: Option<String>,
    /// Folder that holds a folder for each exercise [default: specula-learn, or the last one]. For check, it may be the folder of the exercise itself
    #[arg(long, value_name = "DIR")]
    dir: Option<PathBuf>,
    /// Print JSON (list and check)
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    common: Common,
}

/// Runs the command.
pub fn run(mut args: Args, start: Instant) -> Result<(), Failure> {
    let what = args.what.take();
    if args.common.shaders.is_some() {
        return Err(Failure::Usage(
            "an exercise has a shader tree of its own, so `learn` takes no --shaders; --dir chooses where it lies"
                .into(),
        ));
    }
    if what.as_deref() != Some("check") && args.exercise.is_some() {
        return Err(Failure::Usage(
            "one exercise at a time; only `specula learn check EXERCISE` takes two words".into(),
        ));
    }
    match what.as_deref() {
        Some("list") => list(args.json),
        Some("check") => check(&args),
        Some("reset") => {
            Progress::load().reset();
            out!("No exercise counts as solved any more. Their folders stay as they are.");
            Ok(())
        }
        Some(name) => open(args.common, args.dir, find(name).map_err(Failure::Usage)?, start),
        None => {
            let next = Progress::load().next();
            open(args.common, args.dir, next.ok_or_else(|| Failure::Usage("there is no exercise".into()))?, start)
        }
    }
}

/// Opens an exercise in the window.
fn open(mut common: Common, dir: Option<PathBuf>, exercise: &Exercise, start: Instant) -> Result<(), Failure> {
    let mut progress = Progress::load();
    let parent = dir.or_else(|| progress.folder.clone()).unwrap_or_else(|| FOLDER.into());
    let parent = std::path::absolute(&parent).unwrap_or(parent);
    let is_new = !parent.join(&exercise.name).exists();
    let folder = prepare(&parent, exercise).map_err(Failure::Input)?;
    if is_new {
        tell(format_args!("exercise {} is in {}, a folder of your own to edit", exercise.number, folder.display()));
    }
    progress.set_folder(parent);
    common.shaders = Some(folder);
    common.begin_with(exercise.settings());
    view::run(view::Args::of(Some(PathBuf::from(&exercise.model)), common), start)
}

fn list(json: bool) -> Result<(), Failure> {
    let progress = Progress::load();
    if json {
        let all: Vec<_> = exercises()
            .iter()
            .map(|exercise| {
                let record = progress.of(exercise);
                json!({ "number": exercise.number, "name": exercise.name, "title": exercise.title, "idea": exercise.idea,
                    "solved": record.solved, "hints": record.hints, "saw_solution": record.saw_solution })
            })
            .collect();
        print_json(&all);
        return Ok(());
    }
    for exercise in exercises() {
        let mark = if progress.of(exercise).solved { "solved" } else { "" };
        out!("{:>2}  {:<12} {:<40} {mark}", exercise.number, exercise.slug(), exercise.title);
    }
    out!("\n{} of {} solved. `specula learn` opens the next one.", progress.solved(), exercises().len());
    Ok(())
}

/// Measures the tree of an exercise. The exit code says whether all goals are reached.
fn check(args: &Args) -> Result<(), Failure> {
    let Some(name) = &args.exercise else {
        return Err(Failure::Usage("name the exercise to check, as `specula learn check 3`".into()));
    };
    let exercise = find(name).map_err(Failure::Usage)?;
    let source = Source::open(tree(args.dir.as_deref(), exercise)?);
    let gpu = args.common.gpu()?;
    let progress = super::progress::Progress::new(!args.common.emits());
    progress.say("compiling the shaders and measuring the goals");
    let mut meter = GoalMeter::new(&gpu, &compiler()?);
    let findings = meter.check(exercise, &source, || false).map_err(|error| match error {
        LearnError::Shaders(diagnostics) => Failure::Shaders(diagnostics),
        LearnError::Headless(error) => error.into(),
        other => Failure::Input(other.to_string()),
    });
    drop(meter);
    drop(progress);
    let findings = findings?;
    check_validation(&gpu)?;
    if findings.iter().all(|finding| finding.passed) {
        Progress::load().update(exercise, |record| record.solved = true);
    }
    report(exercise, &findings, args.json)
}

fn report(exercise: &Exercise, findings: &[Finding], json: bool) -> Result<(), Failure> {
    let passed = findings.iter().all(|finding| finding.passed);
    if json {
        print_json(&json!({ "name": exercise.name, "passed": passed, "goals": findings }));
    } else {
        for Finding { goal, passed, found } in findings {
            out!("{}  {goal}\n      {found}", if *passed { "ok  " } else { "FAIL" });
        }
        let end = if passed { "solved" } else { "not solved yet" };
        out!("\nExercise {}, {}: {end}", exercise.number, exercise.title);
    }
    if passed { Ok(()) } else { Err(Failure::Printed) }
}

/// The tree to check: the given folder if it is one, or that of the exercise in it.
fn tree(dir: Option<&Path>, exercise: &Exercise) -> Result<PathBuf, Failure> {
    let parent = match dir {
        Some(dir) => dir.to_owned(),
        None => Progress::load().folder.unwrap_or_else(|| FOLDER.into()),
    };
    let inside = parent.join(&exercise.name);
    let found = [&parent, &inside].into_iter().find(|folder| is_specula_tree(folder)).cloned();
    found.map(|folder| std::path::absolute(&folder).unwrap_or(folder)).ok_or_else(|| {
        Failure::Input(format!(
            "{} holds no tree of exercise {}; `specula learn {}` writes one, and --dir names another folder",
            parent.display(),
            exercise.number,
            exercise.number
        ))
    })
}
