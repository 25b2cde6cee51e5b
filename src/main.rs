//! The command line. One file per command in `commands/`; each calls the library and prints.

mod commands;

use std::process::ExitCode;

fn main() -> ExitCode {
    commands::start()
}
