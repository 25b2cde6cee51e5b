//! `specula check`: every stage with every declared choice, and every library alone; for CI.

use specula::events::{Event, emit};
use specula::shader::{Library, Severity, check};

use super::common::{Common, compiler};
use super::{Failure, print_diagnostics};

/// Options of `check`.
#[derive(clap::Args)]
pub struct Args {
    /// Print JSON: an array of diagnostics
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    common: Common,
}

/// Runs the command. Compiling needs no device.
pub fn run(args: &Args) -> Result<(), Failure> {
    let source = args.common.source()?;
    let mut library = Library::new(source, compiler()?, &specula::render::STAGES);
    let start = std::time::Instant::now();
    let diagnostics = check::check(&mut library);
    let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error).count();
    for diagnostic in &diagnostics {
        emit(args.common.emits(), &Event::Diagnostic(diagnostic));
    }
    if args.json {
        println!("{}", serde_json::to_string_pretty(&diagnostics).unwrap_or_default());
    }
    print_diagnostics(&diagnostics);
    if errors > 0 {
        eprintln!("specula: {errors} error{}", if errors == 1 { "" } else { "s" });
        return Err(Failure::Printed);
    }
    if !args.json && !args.common.emits() {
        let files = library.source().list().len();
        let modes = library.set().map_or(0, |set| set.modes.len());
        println!("checked {files} files, {modes} modes: no errors ({:.0} ms)", start.elapsed().as_secs_f64() * 1e3);
    }
    Ok(())
}
