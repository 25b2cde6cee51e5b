//! `--sheet` and `--turntable`: many pictures in one file.

use std::path::Path;

use specula::capture::{CaptureError, SheetPlan, Turntable, check_animation, modes_of};
use specula::headless::{Headless, Step};
use specula::picture;
use specula::pipeline::Outcome;

use super::args::Args;
use super::{Failure, Progress};

/// Frames a second of a turntable.
const FPS: f32 = 25.0;

/// Whether one of the two is requested.
pub fn is_asked(args: &Args) -> bool {
    args.sheet.is_some() || args.turntable.is_some()
}

/// Fails before any work when the file cannot be written.
pub fn check(args: &Args) -> Result<(), Failure> {
    if args.turntable.is_some() {
        return check_animation(&args.out, args.frames.fps.unwrap_or(FPS)).map_err(Failure::Usage);
    }
    if args.out.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("png")) {
        return Err(Failure::Usage(format!("cannot write {}: a sheet must end in .png", args.out.display())));
    }
    picture::check_path(&args.out).map_err(Failure::Input)
}

/// Writes the sheet or the turntable.
pub fn write(headless: &mut Headless, args: &Args) -> Result<(), Failure> {
    let progress = Progress::new(!args.common.emits());
    progress.say("compiling all modes");
    // All modes and passes are known when all stages have compiled.
    if let Some(Outcome::Failed(diagnostics)) = headless.finish().map(|rest| rest.outcome) {
        return Err(Failure::Shaders(diagnostics));
    }
    progress.say(if args.sheet.is_some() { "sheet" } else { "turntable" });
    let mut tell = |done: u64, of: u64| {
        progress.step(&Step { done, of, unit: "pictures" });
        true
    };
    let written = draw(headless, args, &args.out, &mut tell);
    headless.set_size(args.common.size)?;
    written.map_err(|error| match error {
        CaptureError::Render(error) => error.into(),
        CaptureError::Usage(message) => Failure::Usage(message),
        CaptureError::Write(_) | CaptureError::Canceled => Failure::Input(error.to_string()),
    })
}

fn draw(
    headless: &mut Headless,
    args: &Args,
    out: &Path,
    tell: &mut dyn FnMut(u64, u64) -> bool,
) -> Result<(), CaptureError> {
    if let Some(frames) = args.turntable {
        let (fps, size, turn) = (args.frames.fps.unwrap_or(FPS), args.common.size, args.turn);
        return Turntable { frames, fps, size, turn }.write(headless, out, tell);
    }
    let names: Vec<String> =
        args.sheet.iter().flat_map(|names| names.split(',')).map(|name| name.trim().to_owned()).collect();
    let modes = modes_of(headless.session(), &names).map_err(CaptureError::Usage)?;
    SheetPlan { modes, size: args.tile, columns: None }.write(headless, out, tell)
}
