//! `specula modes`: lists the debug modes, constants and parameters of a shader tree.

use specula::shader::{Library, Update};

use super::common::{Common, compiler};
use super::progress::Progress;
use super::{Failure, print_json};

/// Options of `modes`.
#[derive(clap::Args)]
pub struct Args {
    /// Print a JSON array of the modes
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    common: Common,
}

/// Runs the command. Needs no device.
pub fn run(args: &Args) -> Result<(), Failure> {
    let progress = Progress::new(!args.common.emits());
    progress.say("compiling the shaders");
    let mut library = Library::new(args.common.source()?, compiler()?, &specula::frame::stages::stages());
    let shaders = match library.update(&specula::shader::Change::All) {
        Update::Ready(shaders, _) => shaders,
        Update::Failed(diagnostics, _) => return Err(Failure::Shaders(diagnostics)),
        Update::Unchanged { .. } => return Ok(()),
    };
    drop(progress);
    if args.json {
        print_json(&shaders.modes);
        return Ok(());
    }
    let width = shaders.modes.iter().map(|m| m.slug.len()).max().unwrap_or(0);
    let mut group = "";
    for mode in &shaders.modes {
        if mode.group != group {
            out!("\n{}", mode.group);
            group = &mode.group;
        }
        out!("  {:width$}  {}", mode.slug, mode.doc);
    }
    if !shaders.constants.is_empty() || !shaders.parameters.is_empty() {
        out!("\nShader constants and parameters, for --set NAME=VALUE (`specula help set` lists all other settings)");
    }
    for constant in &shaders.constants {
        let names: Vec<&str> = constant.choices.iter().map(|(name, _)| name.as_str()).collect();
        let choices = if names.is_empty() { String::new() } else { format!(": {}", names.join(" | ")) };
        let chosen = constant.choices.iter().find(|(_, value)| *value == i64::from(constant.default));
        let default = chosen.map(|(name, _)| format!(" = {name}")).unwrap_or_default();
        out!("  {:width$}  {}{choices}{default}", constant.name, constant.label);
    }
    for parameter in &shaders.parameters {
        let range = parameter.range.map(|(low, high)| format!(": {low}..{high}")).unwrap_or_default();
        let default: Vec<String> = parameter.default.iter().map(f64::to_string).collect();
        out!("  {:width$}  {}{range} = {}", parameter.name, parameter.label, default.join(" "));
    }
    Ok(())
}
