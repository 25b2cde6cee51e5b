//! `specula serve`: a session without a window, for programs.

use std::time::Instant;

use super::Failure;
use super::view::{self, Front};

/// Options of `serve`.
#[derive(clap::Args)]
#[command(
    after_help = "Commands come on standard input and events go to standard output, one JSON object a line, as with a window's `--events json`; \
    `specula help commands` lists them. A command that changes the picture is answered when its final picture is there, and `picture` writes it.\n\n\
    The end of standard input ends the session once the commands before it are answered; the command `quit` and a signal end it at once.\n\n\
    As `specula render` does, it begins with a transparent background and at time 0, where the clock stays until `playback` moves it."
)]
pub struct Args {
    #[command(flatten)]
    session: view::Args,
}

/// Runs the command.
pub fn run(args: Args, start: Instant) -> Result<(), Failure> {
    view::run_with(args.session, start, Front::Stdin)
}
