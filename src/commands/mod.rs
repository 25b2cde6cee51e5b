//! Parsing, dispatch, and what all commands share: common options, exit codes, and how results and errors are printed.

/// `println!` for people: escapes the control characters of foreign names. JSON goes through [`print_json`].
macro_rules! out {
    ($($text:tt)*) => { specula::message::print_output(&specula::message::escape_lines(&format!($($text)*))) };
}

mod bench;
mod brdf;
mod check;
mod common;
mod diff;
mod failure;
mod help;
mod info;
mod learn;
mod limits;
mod lsp;
mod mcp;
mod modes;
mod new;
mod output;
mod probe;
mod progress;
mod render;
mod serve;
mod signals;
mod trace;
mod view;

use std::fmt::Display;
use std::io::{ErrorKind, IsTerminal as _};
use std::time::Instant;

use clap::{CommandFactory as _, Parser, Subcommand};
use specula::message::{flush_output, lost_output};

pub use failure::Failure;
pub use output::{print_diagnostics, print_json, tell_left_out};

/// A shader playground: save GLSL, see the model change.
#[derive(Parser)]
#[command(name = "specula", version, about, args_conflicts_with_subcommands = true, disable_help_subcommand = true)]
#[command(
    after_help = "Without a command, `specula [MODEL]` opens the window. `specula help set` lists all settings.\n\n\
    Exit codes:\n  \
    0  Done.\n  \
    1  A model, a shader or another file is missing, does not load or cannot be written;\n     \
       or a check failed (check, diff, brdf, learn check, --validate).\n  \
    2  The command line or a look file is wrong: an unknown command, option or name, or a value that is not\n     \
       allowed, or that this model, shader tree or device does not have.\n  \
    3  There is no usable device or display, or none with the name in --device; or the device was lost (a window:\n     \
       three times in a row), or did not finish within --timeout."
)]
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
    /// Render a picture to a PNG, EXR or NumPy file, without a window
    Render(render::Args),
    /// Serve a program: commands on stdin, events on stdout, pictures as files; without a window
    Serve(serve::Args),
    /// List the debug modes, constants and parameters of the shader tree
    Modes(modes::Args),
    /// Compile every shader, and build the pipelines of every mode and choice; or draw a model and check its assertions and operations; for CI
    Check(check::Args),
    /// Show the devices, the shader tree and the contents of a model
    Info(info::Args),
    /// Write a copy of the shader tree to a new folder, for you to edit
    New(new::Args),
    /// Learn shading by exercises that Specula checks, in the window or in a terminal
    Learn(learn::Args),
    /// Measure reloads, frames, loading and baking
    Bench(bench::Args),
    /// Compare two pictures, or two folders of pictures
    Diff(diff::Args),
    /// Measure or plot the BRDF of the shader tree
    Brdf(brdf::Args),
    /// Print the raw values of a pixel in all debug modes
    Probe(probe::Args),
    /// Print what every statement of the shader computes at a pixel, and check it; for CI
    Trace(trace::Args),
    /// Serve an editor: errors, completion, hover, rename and values at a pixel (language server on stdio)
    Lsp(lsp::Args),
    /// Serve an agent: render and see pictures, edit shaders, read values (Model Context Protocol on stdio)
    Mcp(mcp::Args),
    /// Print the help of a command, or the list of all settings: `specula help set`
    Help(help::Args),
}

/// Runs the program. Returns its exit code.
pub fn start() -> u8 {
    let start = Instant::now();
    let code = limits::check_stack().map_or_else(|failure| end(&failure), |()| main(start));
    flush_output();
    code
}

/// Not inlined, since its arguments alone may need more stack than there is.
#[inline(never)]
fn main(start: Instant) -> u8 {
    use tracing_subscriber::EnvFilter;
    specula::gpu::return_large_blocks();
    // winit warns of every oddity of a display at every start.
    let filter = EnvFilter::try_from_env("SPECULA_LOG").unwrap_or_else(|_| EnvFilter::new("warn,winit=error"));
    let color = std::io::stderr().is_terminal();
    tracing_subscriber::fmt()
        .with_writer(std::io::stderr)
        .with_ansi(color)
        .with_env_filter(filter)
        // It would print them with `eprintln!`.
        .log_internal_errors(false)
        .without_time()
        .init();
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // A misspelled command is read as a model, and clap's message is then about whatever follows it.
            let first = std::env::args_os().nth(1).filter(|_| error.use_stderr());
            return match first.map_or(Ok(()), |word| help::check_command(word.as_ref(), &Cli::command())) {
                Err(failure) => end(&failure),
                Ok(()) => match error.print() {
                    Err(lost) if !error.use_stderr() && lost.kind() != ErrorKind::BrokenPipe => {
                        end(&output_is_lost(&lost))
                    }
                    _ => u8::try_from(error.exit_code()).unwrap_or(2),
                },
            };
        }
    };
    signals::clean_up_on_end();
    let result = match cli.command {
        None => cli
            .view
            .model()
            .map_or(Ok(()), |word| help::check_command(word, &Cli::command()))
            .and_then(|()| view::run(cli.view, start)),
        Some(Command::View(args)) => view::run(args, start),
        Some(Command::Render(args)) => render::run(args, start),
        Some(Command::Serve(args)) => serve::run(args, start),
        Some(Command::Modes(args)) => modes::run(&args),
        Some(Command::Check(args)) => check::run(args),
        Some(Command::Info(args)) => info::run(args),
        Some(Command::New(args)) => new::run(&args),
        Some(Command::Learn(args)) => learn::run(args, start),
        Some(Command::Bench(args)) => bench::run(args, start),
        Some(Command::Diff(args)) => diff::run(&args),
        Some(Command::Brdf(args)) => brdf::run(args),
        Some(Command::Probe(args)) => probe::run(args),
        Some(Command::Trace(args)) => trace::run(args),
        Some(Command::Lsp(args)) => lsp::run(args),
        Some(Command::Mcp(args)) => mcp::run(args),
        Some(Command::Help(args)) => help::run(&args, Cli::command()),
    };
    flush_output();
    let result = result.and_then(|()| lost_output().map_or(Ok(()), |lost| Err(output_is_lost(&lost))));
    result.map_or_else(|failure| end(&failure), |()| 0)
}

fn output_is_lost(why: &dyn Display) -> Failure {
    Failure::Input(format!("cannot write to standard output: {why}"))
}

/// Prints why the program ends.
fn end(failure: &Failure) -> u8 {
    failure.tell();
    failure.exit_code()
}
