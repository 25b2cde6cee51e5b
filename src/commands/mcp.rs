//! `specula mcp`: a server for agents.

use std::ffi::{OsStr, OsString};
use std::io::BufReader;
use std::path::PathBuf;

use specula::control::socket_path;
use specula::mcp::{Config, Connection, Start, remove_temporary, serve};
use specula::process_end::end_process;

use super::common::{BUILT_IN, Common, Models};
use super::view::output::wait_for_end_of_program;
use super::{Failure, limits};

/// Size of the picture without `--size`: agents pay for each pixel that they see.
const SIZE: &str = "640x360";

/// Options of `mcp`.
#[derive(clap::Args)]
#[command(
    after_help = "An agent's program starts this command and talks to it on stdin and stdout, by the Model Context Protocol. Model and \
    options choose the picture, as for `specula render`; the size is 640x360 without --size.\n\
    Tools write to the files of the shader tree and to the output folder, nowhere else. Without --shaders, an agent works on the \
    built-in shaders, and its edits stay in memory."
)]
pub struct Args {
    #[command(flatten)]
    models: Models,
    /// Folder for pictures that the agent saves; without it, it saves none
    #[arg(long, value_name = "DIR")]
    out_folder: Option<PathBuf>,
    /// Join the window that listens there, the --socket of `specula view`; the agent then works on the picture that you see
    #[arg(long, value_name = "NAME|PATH")]
    socket: Option<PathBuf>,
    #[command(flatten)]
    common: Common,
}

/// Runs the command until the agent's program ends it.
pub fn run(mut args: Args) -> Result<(), Failure> {
    args.common.take_files(&mut args.models)?;
    args.common.settings()?;
    limits::check()?;
    let connection = match &args.socket {
        Some(name) => Connection::Join(socket_path(name).map_err(Failure::Usage)?),
        None => {
            let program = std::env::current_exe().map_err(|error| Failure::Device(format!("cannot start: {error}")))?;
            // The program itself, by its name in the command line, after `specula`.
            let given = std::env::args_os().skip_while(|word| word != "mcp").skip(1);
            let mut arguments = vec![OsString::from("serve")];
            if args.common.size.is_none() {
                arguments.extend(["--size", SIZE].map(OsString::from));
            }
            if args.common.shaders.is_none() {
                // A tree that the agent was not given is never written, although other commands take one in the working directory.
                arguments.extend(["--shaders", BUILT_IN].map(OsString::from));
            }
            arguments.extend(without(given, "--out-folder"));
            Connection::Start(Start { program, arguments })
        }
    };
    // A client that is gone waits for nothing that is still under way. The program behind the server notices that, too.
    let client = std::thread::Builder::new().name("specula-mcp-client".to_owned());
    let end_with_client = || {
        if wait_for_end_of_program() {
            remove_temporary();
            end_process(0);
        }
    };
    client.spawn(end_with_client).map_err(|error| Failure::Device(format!("cannot start a thread: {error}")))?;
    let config = Config { connection, out: args.out_folder };
    serve(config, BufReader::new(std::io::stdin()), std::io::stdout())
        .map_err(|error| Failure::Input(format!("cannot serve: {error}")))
}

/// Arguments without an option and its value.
fn without(arguments: impl Iterator<Item = OsString>, option: &str) -> Vec<OsString> {
    let mut left = Vec::new();
    let mut is_value = false;
    for argument in arguments {
        if std::mem::take(&mut is_value) {
            continue;
        }
        let is_joined =
            argument.to_str().is_some_and(|text| text.strip_prefix(option).is_some_and(|rest| rest.starts_with('=')));
        is_value = argument == OsStr::new(option);
        if !is_value && !is_joined {
            left.push(argument);
        }
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_option_goes_with_its_value() {
        for line in
            ["a.glb --out-folder o --env sky", "a.glb --env sky --out-folder=o", "--out-folder o a.glb --env sky"]
        {
            let left = without(line.split(' ').map(OsString::from), "--out-folder");
            assert_eq!(left, ["a.glb", "--env", "sky"], "{line}");
        }
    }
}
