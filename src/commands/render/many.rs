//! `--sheet`, `--sweep`, `--turntable` and `--frames` of a video: many pictures in one file.

use specula::capture::{
    CaptureError, Cell, SheetPlan, Turntable, cells_of_modes, check_animation, modes_of, swept, write_movie,
};
use specula::headless::{Headless, Sequence, Step};
use specula::picture;
use specula::pipeline::Outcome;

use super::args::Args;
use super::{Failure, Progress};
use crate::commands::common::report::check_report;

/// Frames a second of a turntable.
const FPS: f32 = 25.0;
/// Size of a picture of a sheet, pixels.
const TILE: (u32, u32) = (320, 180);
/// Most pictures in the single row of a sweep.
const MOST_COLUMNS: usize = 8;

/// Whether one of them is requested.
pub fn is_asked(args: &Args) -> bool {
    args.is_sheet() || args.turntable.is_some() || is_movie(args)
}

/// Whether all frames of the sequence go into one file.
fn is_movie(args: &Args) -> bool {
    let holds_frames =
        |ending: &std::ffi::OsStr| ["mp4", "webp", "gif"].iter().any(|of| ending.eq_ignore_ascii_case(of));
    let is_one_picture = !args.is_sheet() && args.turntable.is_none();
    is_one_picture && args.frames.frames.is_some() && args.out.extension().is_some_and(holds_frames)
}

/// Fails before any work when the file cannot be written.
pub fn check(args: &Args) -> Result<(), Failure> {
    if args.turntable.is_some() {
        return check_animation(&args.out, args.frames.fps.unwrap_or(FPS)).map_err(Failure::Usage);
    }
    if is_movie(args) {
        return check_animation(&args.out, args.frames.sequence()?.fps).map_err(Failure::Usage);
    }
    if args.out.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("png")) {
        return Err(Failure::Usage(format!("cannot write {}: a sheet must end in .png", args.out.display())));
    }
    if let Some(page) = &args.report {
        check_report(page)?;
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
    progress.say(match args.turntable {
        Some(_) => "turntable",
        None if is_movie(args) => "frames",
        None => "sheet",
    });
    let mut tell = |done: u64, of: u64| {
        progress.step(&Step { done, of, unit: "pictures" });
        true
    };
    let sequence = args.frames.sequence()?;
    let written = draw(headless, args, sequence, &mut tell);
    headless.set_size(args.common.size())?;
    written.map_err(|error| match error {
        CaptureError::Render(error) => error.into(),
        CaptureError::Usage(message) => Failure::Usage(message),
        CaptureError::Write(_) | CaptureError::Canceled => Failure::Input(error.to_string()),
    })
}

fn draw(
    headless: &mut Headless,
    args: &Args,
    sequence: Sequence,
    tell: &mut dyn FnMut(u64, u64) -> bool,
) -> Result<(), CaptureError> {
    let out = args.out.as_path();
    if let Some(frames) = args.turntable {
        let (fps, size, turn) = (args.frames.fps.unwrap_or(FPS), args.common.size(), args.turn.unwrap_or_default());
        return Turntable { frames, fps, size, turn }.write(headless, out, tell);
    }
    if is_movie(args) {
        return write_movie(headless, sequence, out, tell);
    }
    let session = headless.session();
    let cells = match &args.sheet {
        Some(names) => {
            let names: Vec<String> = names.split(',').map(|name| name.trim().to_owned()).collect();
            cells_of_modes(&session.settings, &modes_of(session, &names).map_err(CaptureError::Usage)?)
        }
        None => vec![Cell { settings: session.settings.clone(), ..Cell::default() }],
    };
    let (cells, columns) = swept(cells, &args.sweep, session).map_err(CaptureError::Usage)?;
    // Before the first picture, so that a wrong value is told at once.
    let before = headless.settings_mut().clone();
    let fit = cells.iter().try_for_each(|cell| {
        headless.settings_mut().clone_from(&cell.settings);
        headless.check_settings()
    });
    *headless.settings_mut() = before;
    fit?;
    let is_grid = args.sweep.len() + usize::from(args.sheet.is_some()) > 1;
    let columns = (is_grid || (!args.sweep.is_empty() && columns <= MOST_COLUMNS)).then_some(columns as u32);
    let (size, page) = (args.tile.unwrap_or(TILE), args.page.unwrap_or_default());
    let plan = SheetPlan { cells, size, columns, page };
    match &args.report {
        Some(page) => plan.write_with_page(headless, (out, page), tell),
        None => plan.write(headless, out, tell),
    }
}
