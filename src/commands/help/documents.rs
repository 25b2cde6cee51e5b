//! Man pages and shell completions, which packages install.

use std::fs;
use std::path::Path;

use clap::Command;
use clap_complete::Shell;
use clap_mangen::Man;
use specula::message::print_output;

use crate::commands::Failure;

/// Prints the man page of a command.
pub(super) fn print_man_page(command: Command) -> Result<(), Failure> {
    let mut page = Vec::new();
    Man::new(command).render(&mut page).map_err(|error| Failure::Input(error.to_string()))?;
    print_output(String::from_utf8_lossy(&page).trim_end());
    Ok(())
}

/// Writes the man pages of the program and of all its commands to a folder: `specula.1`, `specula-render.1` and so on.
pub(super) fn write_man_pages(program: Command, folder: &Path) -> Result<(), Failure> {
    let written = fs::create_dir_all(folder).and_then(|()| clap_mangen::generate_to(program, folder));
    written.map_err(|error| Failure::Input(format!("cannot write man pages to {}: {error}", folder.display())))
}

/// Prints the script with which a shell completes the command line of Specula.
pub(super) fn print_completions(mut program: Command, shell: Shell) {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut program, "specula", &mut script);
    print_output(String::from_utf8_lossy(&script).trim_end());
}
