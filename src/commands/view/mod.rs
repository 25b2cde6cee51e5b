//! `specula view`: opens the window, in a child process; and the same session without a window, for `specula serve`.

mod end_of_input;
pub(super) mod output;
pub mod supervisor;

use std::collections::BTreeMap;
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use specula::app::{self, AppError, AppOptions, OtherPicture};
use specula::control::{Control, Socket, socket_path};
use specula::gpu::{GpuError, watchdog};
use specula::message;
use specula::process_end::end_process;
use specula::recovery::{GoodTexts, HUNG, LOST, Recorder, RecoveryState, SessionState};
use specula::scene::LoadOptions;
use specula::shader::Source;

use super::Failure;
use super::common::names::check_model_path;
use super::common::{Common, EventFormat, Models, compiler};
use super::limits;
use supervisor::Forward;

/// Largest width and height of a window in pixels: larger than any screen, and within the limits of window systems.
const LARGEST_WINDOW: u32 = 16384;

/// Options of `view`.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    models: Models,
    /// Take commands on a local socket: a file that only you can open. A name without a slash lies in $XDG_RUNTIME_DIR/specula
    #[arg(long, value_name = "NAME|PATH")]
    socket: Option<PathBuf>,
    /// Compare the picture with one from a file: PNG, JPEG, HDR or EXR. The window follows the file
    #[arg(long, value_name = "FILE", conflicts_with = "compare_tree")]
    compare: Option<PathBuf>,
    /// Compare the picture with that of another shader tree. The window follows its files
    #[arg(long, value_name = "DIR|FILE")]
    compare_tree: Option<PathBuf>,
    #[command(flatten)]
    common: Common,
}

impl Args {
    /// The options of another command that opens the window.
    pub fn of(model: Option<PathBuf>, common: Common) -> Self {
        Self { models: model.into(), socket: None, compare: None, compare_tree: None, common }
    }

    /// The model as given on the command line.
    pub fn model(&self) -> Option<&Path> {
        self.models.model.as_deref()
    }
}

/// Whether the session has a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Front {
    /// For a user.
    Window,
    /// For a program on standard input, with whose end the session ends.
    Stdin,
}

/// Runs the command.
pub fn run(args: Args, start: Instant) -> Result<(), Failure> {
    run_with(args, start, Front::Window)
}

/// Runs a session: here if this is the child, else in the child.
pub fn run_with(mut args: Args, start: Instant, front: Front) -> Result<(), Failure> {
    args.common.take_files(&mut args.models)?;
    if front == Front::Stdin {
        args.common.events = Some(EventFormat::Json);
    }
    let forwards = match front {
        Front::Stdin => Forward::All,
        Front::Window if reads_commands(&args) => Forward::Lines,
        Front::Window => Forward::Nothing,
    };
    match supervisor::session() {
        Some(folder) => open(args, start, Some(folder), front),
        None => supervisor::run(forwards, || open(args, start, None, front)),
    }
}

/// Whether commands for a window come on standard input. A terminal is not read: it would stop the window of a background job.
fn reads_commands(args: &Args) -> bool {
    args.common.emits() && !std::io::stdin().is_terminal()
}

/// Starts to print events and to read commands.
fn control(args: &Args, is_supervised: bool, front: Front) -> Result<Control, Failure> {
    let mut control = Control::new();
    if is_supervised {
        supervisor::wake_with_parent();
    }
    if args.common.emits() {
        let stdout = control.print_events();
        if front == Front::Stdin {
            end_of_input::read(&control, stdout, is_supervised);
        } else if is_supervised {
            control.read(std::io::stdin(), stdout, |_| {
                supervisor::end();
                None
            });
        } else if reads_commands(args) {
            control.read(std::io::stdin(), stdout, |_| None);
        }
    } else if is_supervised {
        supervisor::end_with_parent();
    }
    if let Some(name) = &args.socket {
        let socket = socket_path(name).and_then(Socket::bind).map_err(Failure::Input)?;
        control.listen(socket);
    }
    Ok(control)
}

/// Opens the window, or the session without one. With the `folder` of a session, goes on where the process before was lost.
fn open(args: Args, start: Instant, folder: Option<PathBuf>, front: Front) -> Result<(), Failure> {
    limits::check()?;
    let has_window = front == Front::Window;
    let control = control(&args, folder.is_some(), front)?;
    check_model_path(args.models.model.as_deref())?;
    let (width, height) = args.common.size();
    if has_window && width.max(height) > LARGEST_WINDOW {
        let message =
            format!("--size {width}x{height} is too large for a window; at most {LARGEST_WINDOW} pixels a side");
        return Err(Failure::Usage(message));
    }
    let source = args.common.source()?;
    let given = SessionState {
        settings: Arc::new(match front {
            Front::Window => args.common.settings_of_window()?,
            Front::Stdin => args.common.settings()?,
        }),
        model: args.models.model,
        scene: args.common.load_options().scene,
        tree: source.location().map(Path::to_owned),
    };
    let follows_lights = args.common.leaves_lights_open();
    let follows_environment = args.common.leaves_environment_open();
    let state = folder.as_deref().map(RecoveryState::read).unwrap_or_default();
    // A model and options say what is wanted, and after a loss the record does.
    let is_plain = has_window && given.model.is_none() && args.common.chooses_nothing() && state.work.is_none();
    let restored = is_plain.then(|| app::session_to_restore(given.tree.as_deref())).flatten();
    let plain = (is_plain && restored.is_none()).then(|| given.clone());
    let work = state.work.clone().or(restored).unwrap_or(given);
    let good = folder.as_deref().map(|folder| GoodTexts::read(folder, work.tree.as_deref())).unwrap_or_default();
    let is_supervised = folder.is_some();
    let compare = args.compare.map(OtherPicture::File).or(args.compare_tree.map(OtherPicture::Tree));
    // After a loss the other picture is suspected, too.
    let compare = compare.filter(|_| state.work.is_none());
    if is_supervised {
        watchdog::end_after(Duration::from_secs(args.common.timeout.into()), end_of_device);
    }
    let source = match &work.tree {
        Some(tree) => Source::open(tree.clone()),
        None if source.location().is_none() => source,
        None => Source::embedded(),
    };
    let source = state.source(source, good.clone());
    // The size of the last window, unless one was given.
    let last = if has_window && args.common.size.is_none() { app::last_size() } else { None };
    let added = work.settings.added_files();
    // Texts in memory are in the record alone.
    let has_texts = state.loss.is_some() && source.location().is_none() && good.tree.is_none();
    let texts = if has_texts { good.over_built_in() } else { BTreeMap::new() };
    let options = AppOptions {
        source,
        texts,
        compiler: compiler()?,
        model: work.model,
        // After a loss the settings are those of the session.
        follows_lights: has_window && follows_lights && state.work.is_none(),
        follows_environment: has_window && follows_environment && state.work.is_none(),
        settings: Arc::unwrap_or_clone(work.settings),
        plain,
        size: state.window.map(|window| window.size).or(last).unwrap_or_else(|| args.common.size()),
        at: state.window.and_then(|window| window.at),
        compare,
        load_options: LoadOptions { scene: work.scene, added, ..args.common.load_options() },
        validation: args.common.validate,
        device: args.common.device,
        control,
        recorder: Recorder::new(folder, state, good),
        start,
    };
    let ended = if has_window { app::run(options) } else { app::serve(options) };
    ended.map_err(|error| match error {
        AppError::Gpu(GpuError::DeviceLost(_)) if is_supervised => {
            message::tell(error);
            end_process(LOST)
        }
        AppError::Validation(_) => Failure::Input(error.to_string()),
        AppError::Size(..) => Failure::Usage(error.to_string()),
        AppError::NoDisplay(_) | AppError::Gpu(_) => Failure::Device(error.to_string()),
    })
}

/// Ends the child when the device does not answer.
fn end_of_device(what: &str, limit: Duration) -> ! {
    message::tell(format_args!(
        "the graphics device has not finished {what} within {} s (`--timeout SECONDS`)",
        limit.as_secs()
    ));
    end_process(HUNG)
}
