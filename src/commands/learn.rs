//! `specula learn`: exercises, in the window or checked in a terminal.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use serde_json::json;
use specula::learn::{Exercise, Finding, GoalMeter, LearnError, Progress, exercise_of, exercises, find, prepare};
use specula::message::tell;
use specula::shader::{Source, is_specula_tree};

use super::common::{Common, check_validation, compiler};
use super::{Failure, print_json, view};

/// Where the folders of the exercises are, if nothing else is chosen.
const FOLDER: &str = "specula-learn";

/// Options of `learn`.
#[derive(clap::Args)]
pub struct Args {
    /// Number, name or folder of an exercise to open [default: the first unsolved one]; or list, check or reset
    #[arg(value_name = "EXERCISE|list|check|reset")]
    what: Option<String>,
    /// Exercise to check: its number or name, its folder that `specula learn` has made, or the folder that describes one [default: that of the
    /// working directory]; or all, for each folder below DIR
    #[arg(value_name = "EXERCISE|all")]
    exercise: Option<String>,
    /// Folder that holds a folder for each exercise [default: specula-learn, or the last one]. For check, it may be the folder of the exercise itself,
    /// and for check all it may hold a folder of each student
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
        Some("check") if args.exercise.as_deref() == Some("all") => check_all(&args),
        Some("check") => check(&args),
        Some("reset") => {
            Progress::load().reset();
            out!("No exercise counts as solved any more. Their folders stay as they are.");
            Ok(())
        }
        Some(name) => {
            let exercise = find(name).map_err(Failure::Usage)?;
            open(args.common, args.dir, &exercise, start)
        }
        None => {
            let next = Progress::load().next().ok_or_else(|| Failure::Usage("there is no exercise".into()))?;
            open(args.common, args.dir, &next, start)
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
        tell(format_args!("exercise {} is in {}, a folder of your own to edit", exercise.label(), folder.display()));
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
    // A folder that `specula learn` has made says which exercise it is of.
    let folder = args.exercise.as_deref().map(Path::new).filter(|folder| folder.is_dir());
    let folder = folder.filter(|folder| args.dir.is_none() && exercise_of(folder).is_some());
    let dir = folder.map(Path::to_owned).or_else(|| args.dir.clone()).unwrap_or_else(|| ".".into());
    let named = args.exercise.as_deref().filter(|_| folder.is_none());
    let exercise = match named {
        Some(name) => find(name).map_err(Failure::Usage)?,
        None => exercise_of(&dir).ok_or_else(|| {
            let dir = dir.display();
            Failure::Usage(format!(
                "{dir} is no folder of an exercise; name the exercise, as `specula learn check 3`, or `specula learn check all`"
            ))
        })?,
    };
    let source = Source::open(match named {
        Some(_) => tree(args.dir.as_deref(), &exercise)?,
        None => std::path::absolute(&dir).unwrap_or(dir),
    });
    let gpu = args.common.gpu()?;
    let progress = super::progress::Progress::new(!args.common.emits());
    progress.say("compiling the shaders and measuring the goals");
    let mut meter = GoalMeter::new(&gpu, &compiler()?);
    let findings = meter.check(&exercise, &source, || false).map_err(failure);
    drop(meter);
    drop(progress);
    let findings = findings?;
    check_validation(&gpu)?;
    if findings.iter().all(|finding| finding.passed) {
        Progress::load().update(&exercise, |record| record.solved = true);
    }
    report(&exercise, &findings, args.json)
}

fn failure(error: LearnError) -> Failure {
    match error {
        LearnError::Shaders(diagnostics) => Failure::Shaders(diagnostics),
        LearnError::Headless(error) => error.into(),
        other => Failure::Input(other.to_string()),
    }
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
        out!("\nExercise {}, {}: {end}", exercise.label(), exercise.title);
    }
    if passed { Ok(()) } else { Err(Failure::Printed) }
}

/// Measures every folder of an exercise below the given one, and prints a table. The exit code says whether all are solved. The progress of
/// the user who checks stays as it is.
fn check_all(args: &Args) -> Result<(), Failure> {
    let dir = args.dir.clone().or_else(|| Progress::load().folder).unwrap_or_else(|| FOLDER.into());
    let mut found: Vec<(PathBuf, Arc<Exercise>)> = Vec::new();
    collect(&dir, DEPTH, &mut found);
    if found.is_empty() {
        return Err(Failure::Input(format!("{} holds no folder of an exercise", dir.display())));
    }
    // Exercise by exercise, so that each solution is compiled once.
    found.sort_by(|(a, of_a), (b, of_b)| (&of_a.name, a).cmp(&(&of_b.name, b)));
    let gpu = args.common.gpu()?;
    let progress = super::progress::Progress::new(!args.common.emits());
    let mut meter = GoalMeter::new(&gpu, &compiler()?);
    let mut results = Vec::new();
    for (index, (folder, exercise)) in found.iter().enumerate() {
        progress.say(&format!("measuring {} of {}: {}", index + 1, found.len(), folder.display()));
        let source = Source::open(std::path::absolute(folder).unwrap_or_else(|_| folder.clone()));
        let measured = match meter.check(exercise, &source, || false) {
            Err(LearnError::Headless(error)) => return Err(error.into()),
            measured => measured.map_err(|error| first_line(&error)),
        };
        results.push((folder.strip_prefix(&dir).unwrap_or(folder), exercise, measured));
    }
    drop(meter);
    drop(progress);
    check_validation(&gpu)?;
    results.sort_by_key(|(folder, ..)| *folder);
    let is_solved = |measured: &Measured| measured.as_ref().is_ok_and(|goals| goals.iter().all(|goal| goal.passed));
    let solved = results.iter().filter(|(.., measured)| is_solved(measured)).count();
    if args.json {
        let row = |(folder, exercise, measured): &(&Path, &Arc<Exercise>, Measured)| {
            json!({ "folder": folder, "name": exercise.name, "passed": is_solved(measured),
                "goals": measured.as_deref().unwrap_or_default(), "error": measured.as_ref().err() })
        };
        print_json(&results.iter().map(row).collect::<Vec<_>>());
    } else {
        let width = results.iter().map(|(folder, ..)| folder.display().to_string().chars().count()).max().unwrap_or(0);
        for (folder, exercise, measured) in &results {
            let result = match measured {
                Err(message) => format!("error: {message}"),
                Ok(_) if is_solved(measured) => "solved".to_owned(),
                Ok(goals) => {
                    let reached = goals.iter().filter(|goal| goal.passed).count();
                    format!("{reached} of {} goals", goals.len())
                }
            };
            out!("{:width$}  {:<14} {result}", folder.display().to_string(), exercise.name);
        }
        out!("\n{solved} of {} solved", results.len());
    }
    if solved == results.len() { Ok(()) } else { Err(Failure::Printed) }
}

/// The findings of a folder, or why it was not measured.
type Measured = Result<Vec<Finding>, String>;

/// How far `check all` looks below its folder: a folder of each student, with the folders of the exercises in it or one further down.
const DEPTH: usize = 3;

/// The folders of exercises in `dir`, down to a depth.
fn collect(dir: &Path, depth: usize, found: &mut Vec<(PathBuf, Arc<Exercise>)>) {
    if let Some(exercise) = exercise_of(dir) {
        return found.push((dir.to_owned(), exercise));
    }
    let entries = std::fs::read_dir(dir).into_iter().flatten().flatten();
    let is_folder = |entry: &std::fs::DirEntry| entry.file_type().is_ok_and(|kind| kind.is_dir());
    for entry in entries.filter(|entry| depth > 0 && is_folder(entry)) {
        collect(&entry.path(), depth - 1, found);
    }
}

/// The error in a line: that of shaders is their first one.
fn first_line(error: &LearnError) -> String {
    match error {
        LearnError::Shaders(diagnostics) if !diagnostics.is_empty() => diagnostics[0].one_line(),
        other => other.to_string().lines().next().unwrap_or_default().to_owned(),
    }
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
        let label = exercise.label();
        Failure::Input(format!(
            "{} holds no tree of exercise {label}; `specula learn {label}` writes one, and --dir names another folder",
            parent.display(),
        ))
    })
}
