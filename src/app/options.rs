//! How to open the window or a session without one, and the work that begins before it is open.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use winit::raw_window_handle::RawDisplayHandle;

use crate::control::{Clients, Control};
use crate::gpu::{GpuOptions, PipelineStore};
use crate::pipeline::DiskPipelines;
use crate::recovery::{Recorder, SessionState};
use crate::scene::LoadOptions;
use crate::settings::Settings;
use crate::shader::{Compiler, Source, TreePath, Watcher};
use crate::threads::loader::{self, Reading};
use crate::threads::{MessageSender, watch_files};

/// How to open the window.
pub struct AppOptions {
    /// Shader tree.
    pub source: Source,
    /// Texts over the built-in shaders, which a session before a loss has drawn.
    pub texts: BTreeMap<TreePath, Arc<str>>,
    /// Shader compiler.
    pub compiler: Arc<Compiler>,
    /// Model file; `None` is the built-in shader ball.
    pub model: Option<PathBuf>,
    /// Settings to start with.
    pub settings: Settings,
    /// The session state of a window that opens without a model and options. If the window starts with this state, it offers to
    /// restore the last session.
    pub plain: Option<SessionState>,
    /// Whether a model that has lights is lit by them: the user has not chosen which lights shine.
    pub follows_lights: bool,
    /// Whether a model that has an environment is lit by it: the user has not chosen one.
    pub follows_environment: bool,
    /// Size of the window, or of the picture without one, in pixels.
    pub size: (u32, u32),
    /// Upper left corner of the window on the desktop in pixels; `None` leaves it to the window system.
    pub at: Option<(i32, i32)>,
    /// Persists the session for the process that continues it after a loss of the device.
    pub recorder: Recorder,
    /// Part of the name of the device to use.
    pub device: Option<String>,
    /// Whether to enable the validation layers.
    pub validation: bool,
    /// The file or shader tree to compare the picture with.
    pub compare: Option<OtherPicture>,
    /// How models are loaded.
    pub load_options: LoadOptions,
    /// Those who get events and send commands.
    pub control: Control,
    /// Start of the program, for the events' times.
    pub start: Instant,
}

impl AppOptions {
    /// The device to open. `display`: that of the window.
    pub(super) fn gpu(&self, display: Option<RawDisplayHandle>) -> GpuOptions {
        GpuOptions {
            device: self.device.clone(),
            validation: self.validation,
            display,
            // After a loss, the stored pipelines are suspected, too.
            pipelines: (!self.recorder.is_safe_mode()).then_some(&DiskPipelines as &dyn PipelineStore),
        }
    }
}

/// The other picture of a comparison.
#[derive(Clone, Debug)]
pub enum OtherPicture {
    /// A picture from a file.
    File(PathBuf),
    /// The picture of another shader tree.
    Tree(PathBuf),
}

/// Work that needs neither window nor device, so it starts before them.
pub(super) struct Early {
    pub(super) watcher: Option<Watcher>,
    pub(super) reading: Reading,
    pub(super) events: Clients,
}

impl Early {
    pub(super) fn begin(options: &AppOptions, events: &Clients, sender: &MessageSender) -> Self {
        // Watch the file before reading it, so that no save is missed in between.
        let files: Vec<PathBuf> = options.model.iter().filter_map(|path| std::path::absolute(path).ok()).collect();
        let watcher = watch_files(&files, sender).unwrap_or_else(|message| {
            crate::message::tell(message);
            None
        });
        let compiler = options.compiler.clone();
        // Both only begin early what would be done later.
        let _ = std::thread::Builder::new().spawn(move || compiler.warm());
        let _ = std::thread::Builder::new().spawn(crate::learn::exercises);
        let reading = loader::read(options.model.clone(), options.load_options.clone(), true);
        Self { watcher, reading, events: events.clone() }
    }
}
