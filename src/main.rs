//! The command line. One file per command in `commands/`; each calls the library and prints.

mod commands;

fn main() {
    // Threads may be in the compiler or in the driver.
    specula::process_end::end_process(commands::start())
}
