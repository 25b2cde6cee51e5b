//! `specula new DIR`: writes the built-in shader tree to a new folder.

use std::path::PathBuf;

use specula::shader::embedded;

use super::Failure;

/// Options of `new`.
#[derive(clap::Args)]
pub struct Args {
    /// Folder to create; it must be new or empty
    dir: PathBuf,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let written = embedded::write_to(&args.dir)
        .map_err(|e| Failure::Input(format!("cannot write the shader tree to {}: {e}", args.dir.display())))?;
    out!("wrote {} files to {}", written.len(), args.dir.display());
    out!("Next: run specula --shaders {}, then edit user.glsl or brdf/ndf.glsl and save.", args.dir.display());
    Ok(())
}
