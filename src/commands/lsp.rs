//! `specula lsp`: a language server for editors.

use std::io::{BufRead as _, BufReader};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::Arc;

use specula::control::socket_path;
use specula::gpu::{Gpu, GpuOptions};
use specula::headless::Headless;
use specula::lsp::{Config, OpenTree, OpenWindow, serve, text_of};
use specula::pipeline::DiskPipelines;
use specula::shader::Compiler;

use super::common::frames::Frames;
use super::common::{Common, Models, compiler};
use super::{Failure, limits};

/// Options of `lsp`.
#[derive(clap::Args)]
#[command(
    after_help = "An editor starts this command and talks to it on stdin and stdout. It finds the shader tree of each file that is open, \
    so --shaders has no effect.\n\
    Model and options are those of the picture whose pixel the command specula.pinPixel traces, as `specula trace` has them."
)]
pub struct Args {
    #[command(flatten)]
    models: Models,
    /// Talk on stdin and stdout, as always; for editors that name the way
    #[arg(long)]
    stdio: bool,
    /// Window that shows expressions over the model: the --socket of `specula view` [default: any that listens]
    #[arg(long, value_name = "NAME|PATH")]
    socket: Option<PathBuf>,
    #[command(flatten)]
    frames: Frames,
    #[command(flatten)]
    common: Common,
}

/// Runs the command until the editor ends it.
pub fn run(mut args: Args) -> Result<(), Failure> {
    // Editors pass --stdio, which is the only way.
    let _ = args.stdio;
    args.common.take_files(&mut args.models)?;
    args.common.settings()?;
    args.frames.sequence()?;
    limits::check()?;
    let socket = args.socket.as_deref().map(socket_path).transpose().map_err(Failure::Usage)?;
    let compiler = compiler()?;
    let open_window = window_opener(args.models.model.clone(), args.socket.clone());
    let (size, open) = (args.common.size(), opening(args, compiler.clone()));
    let config = Config { open, size, socket, open_window };
    match serve(config, compiler, BufReader::new(std::io::stdin()), std::io::stdout()) {
        Ok(true) => Ok(()),
        Ok(false) => Err(Failure::Printed),
        Err(error) => Err(Failure::Device(format!("cannot start the language server: {error}"))),
    }
}

/// Opens windows with the model of the command line, on a socket on which the server finds them. They stay when the server ends.
fn window_opener(model: Option<PathBuf>, socket: Option<PathBuf>) -> OpenWindow {
    let socket = socket.unwrap_or_else(|| format!("lsp-{}", std::process::id()).into());
    Arc::new(move |root| {
        let program = std::env::current_exe().map_err(|error| format!("the program is not found: {error}"))?;
        let mut command = Command::new(program);
        command.arg("view").args(&model).arg("--shaders").arg(root).arg("--socket").arg(&socket);
        command.args(["--events", "json"]).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        // The editor's Ctrl+C is not the window's.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let cannot = |error: std::io::Error| format!("the window does not start: {error}");
        let mut child = command.spawn().map_err(cannot)?;
        let (stdout, stderr) = (child.stdout.take(), child.stderr.take());
        let mut events = stdout.into_iter().flat_map(|stdout| BufReader::new(stdout).lines()).map_while(Result::ok);
        let is_open = events.any(|event| event.contains("\"event\":\"ready\""));
        let mut told = stderr.into_iter().flat_map(|stderr| BufReader::new(stderr).lines()).map_while(Result::ok);
        if !is_open {
            let _ = child.wait();
            return Err(told.last().unwrap_or_else(|| "the window has closed".to_owned()));
        }
        // Events and messages of the window are read as long as both run.
        let drain = move || {
            std::thread::spawn(move || told.by_ref().for_each(drop));
            events.for_each(drop);
            let _ = child.wait();
        };
        std::thread::Builder::new().name("specula-lsp-opened".to_owned()).spawn(drain).map(drop).map_err(cannot)
    })
}

/// Opens trees as `specula trace` does, on a device that is opened once.
fn opening(args: Args, compiler: Arc<Compiler>) -> OpenTree {
    let mut device: Option<Arc<Gpu>> = None;
    Box::new(move |source| {
        let mut settings = args.common.settings().map_err(text)?;
        let gpu = match &device {
            Some(gpu) => gpu.clone(),
            None => {
                // Without the limit of time that ends other commands: the editor keeps its server.
                let options = GpuOptions {
                    device: args.common.device.clone(),
                    validation: args.common.validate,
                    display: None,
                    pipelines: Some(&DiskPipelines),
                };
                device.insert(Gpu::new(&options).map_err(|error| error.to_string())?).clone()
            }
        };
        let model = args.common.model(args.models.model.as_deref()).map_err(text)?;
        args.common.fit(&model, &mut settings).map_err(text)?;
        let (mode, size) = (settings.mode.clone(), args.common.size());
        let opened = Headless::new(&gpu, &compiler, source, model, settings, size);
        let (mut headless, _) = opened.map_err(|error| text_of(&error))?;
        headless.set_sequence(args.frames.sequence().map_err(text)?);
        Ok((headless, mode))
    })
}

/// A failure in words.
fn text(failure: Failure) -> String {
    match failure {
        Failure::Input(message) | Failure::Usage(message) | Failure::Device(message) => message,
        Failure::Shaders(diagnostics) => {
            diagnostics.first().map_or_else(|| "the shaders are wrong".to_owned(), |first| first.one_line())
        }
        Failure::Printed | Failure::Window(_) => "it failed".to_owned(),
    }
}
