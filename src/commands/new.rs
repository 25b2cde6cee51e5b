//! `specula new DIR`: writes the built-in shader tree to a new folder.

use std::path::PathBuf;

use specula::shader::embedded;

use super::Failure;
use super::common::example;

/// Options of `new`.
#[derive(clap::Args)]
pub struct Args {
    /// Folder to create; it must be new or empty
    dir: PathBuf,

    /// Example to start from: deferred, displacement, fluid, fur, hatching, hull, life, meshlets, normals, particles, raymarch, reaction, swarm or toy
    #[arg(long, value_name = "NAME")]
    template: Option<String>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let example = args.template.as_deref().map(example).transpose()?;
    let written = embedded::write_to(&args.dir, example)
        .map_err(|e| Failure::Input(format!("cannot write the shader tree to {}: {e}", args.dir.display())))?;
    out!("wrote {} files to {}", written.len(), args.dir.display());
    let first = example.map_or("user.glsl or brdf/ndf.glsl", |_| "a file in passes/");
    out!("Next: run specula --shaders {}, then edit {first} and save.", args.dir.display());
    Ok(())
}
