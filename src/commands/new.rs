//! `specula new DIR`: the shader tree, to start from.

use std::path::PathBuf;

use specula::shader::embedded;

use super::Failure;

/// Options of `new`.
#[derive(clap::Args)]
pub struct Args {
    /// Folder to make; it must not hold anything yet
    dir: PathBuf,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let written = embedded::write_to(&args.dir)
        .map_err(|e| Failure::Input(format!("cannot write the shader tree to {}: {e}", args.dir.display())))?;
    out!("wrote {} files to {}", written.len(), args.dir.display());
    out!("try: specula --shaders {}   and edit user.glsl or brdf/ndf.glsl", args.dir.display());
    Ok(())
}
