//! Parsing, dispatch, and what all commands share: common options, exit codes, the way errors are printed.

/// `println!` that does not mind a reader who went away, as `specula modes | head` does.
macro_rules! out {
    ($($text:tt)*) => {{
        use std::io::Write as _;
        let _ = writeln!(std::io::stdout().lock(), $($text)*);
    }};
}

mod bench;
mod brdf;
mod check;
mod common;
mod diff;
mod info;
mod modes;
mod new;
mod probe;
mod render;
mod signals;
mod view;
mod watch;

use std::io::IsTerminal as _;
use std::process::ExitCode;
use std::time::Instant;

use clap::{Parser, Subcommand};
use specula::gpu::GpuError;
use specula::headless::HeadlessError;
use specula::render::UploadError;
use specula::shader::Diagnostic;

/// A shader playground: save GLSL, see the model change.
#[derive(Parser)]
#[command(name = "specula", version, about, args_conflicts_with_subcommands = true)]
#[command(after_help = "Without a command, `specula [MODEL]` opens the window.\n\
    Exit codes: 0 done, 1 your input is wrong (printed as file:line), 2 usage, 3 no usable device or display.")]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    view: view::Args,
}

#[derive(Subcommand)]
enum Command {
    /// Open the window (the default)
    View(view::Args),
    /// Render to a PNG or EXR, without a window
    Render(render::Args),
    /// List the debug modes, constants and parameters of the shader tree
    Modes(modes::Args),
    /// Compile every shader with every declared choice; for CI
    Check(check::Args),
    /// Tell about the devices, the model and the shader tree
    Info(info::Args),
    /// Write the shader tree to a new folder, to start from
    New(new::Args),
    /// Measure reloads, frames and loading
    Bench(bench::Args),
    /// Compare pictures, or folders of them
    Diff(diff::Args),
    /// Measure the BRDF of the shader tree, or plot it
    Brdf(brdf::Args),
    /// Print the raw values of a pixel in every debug mode
    Probe(probe::Args),
}

/// Why a command ends early. Everything is printed once, here.
#[derive(Debug)]
pub enum Failure {
    /// The user's input is wrong: exit code 1.
    Input(String),
    /// The user's shaders are wrong: exit code 1.
    Shaders(Vec<Diagnostic>),
    /// It was printed already: exit code 1.
    Printed,
    /// No device, no display: exit code 3.
    Device(String),
}

impl From<GpuError> for Failure {
    fn from(error: GpuError) -> Self {
        Self::Device(error.to_string())
    }
}

impl From<HeadlessError> for Failure {
    fn from(error: HeadlessError) -> Self {
        match error {
            HeadlessError::Shaders(diagnostics) => Self::Shaders(diagnostics),
            HeadlessError::Gpu(error) | HeadlessError::Upload(UploadError::Gpu(error)) => error.into(),
            other => Self::Input(other.to_string()),
        }
    }
}

/// Runs the program that started at `start`.
pub fn main(start: Instant) -> ExitCode {
    use tracing_subscriber::EnvFilter;
    // winit warns of every oddity of a display at every start.
    let filter = EnvFilter::try_from_env("SPECULA_LOG").unwrap_or_else(|_| EnvFilter::new("warn,winit=error"));
    let color = std::io::stderr().is_terminal();
    tracing_subscriber::fmt()
        .with_writer(std::io::stderr)
        .with_ansi(color)
        .with_env_filter(filter)
        .without_time()
        .init();
    let cli = Cli::parse();
    signals::clean_up_on_end();
    let result = match cli.command {
        None => view::run(cli.view, start),
        Some(Command::View(args)) => view::run(args, start),
        Some(Command::Render(args)) => render::run(args, start),
        Some(Command::Modes(args)) => modes::run(&args),
        Some(Command::Check(args)) => check::run(&args),
        Some(Command::Info(args)) => info::run(&args),
        Some(Command::New(args)) => new::run(&args),
        Some(Command::Bench(args)) => bench::run(args, start),
        Some(Command::Diff(args)) => diff::run(&args),
        Some(Command::Brdf(args)) => brdf::run(args),
        Some(Command::Probe(args)) => probe::run(args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            report(&failure);
            ExitCode::from(if matches!(failure, Failure::Device(_)) { 3 } else { 1 })
        }
    }
}

fn report(failure: &Failure) {
    match failure {
        Failure::Input(message) | Failure::Device(message) => eprintln!("specula: {message}"),
        Failure::Shaders(diagnostics) => print_diagnostics(diagnostics),
        Failure::Printed => {}
    }
}

/// Prints diagnostics to stderr: `file:line: error: message`, which editors parse, then the source line with its caret.
pub fn print_diagnostics(diagnostics: &[Diagnostic]) {
    for diagnostic in diagnostics {
        eprintln!("{}", diagnostic.full());
    }
}
