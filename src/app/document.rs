//! What the window shows and what the user has set. Only the window's thread touches it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Instant;

use winit::event_loop::EventLoopProxy;

use crate::events::{Event, ReloadEvent, emit};
use crate::gpu::{Buffer, Gpu, GpuError, SetLayouts, vk};
use crate::headless;
use crate::interface::{FEATURE_NORMAL_TEXTURE, FEATURE_PACKED_OCCLUSION};
use crate::render::{GpuEnvironment, GpuScene, MaterialVariant, PipelineSet, Wanted};
use crate::scene::Model;
use crate::settings::{LightSource, Settings};
use crate::shader::{Batch, Change, Diagnostic, Mode, ShaderSet, Source, TreePath, Watcher, is_specula_tree};

use super::camera::CameraHand;
use super::environment::Surroundings;
use super::input::Mouse;
use super::worker::{Needs, Worker};
use super::{AppOptions, Early, Message};

/// What the last frame was drawn with, and the next one is until something better is complete.
#[derive(Clone)]
pub(super) struct Shown {
    pub(super) pipelines: Arc<PipelineSet>,
    pub(super) wanted: Wanted,
    pub(super) scene: Option<Arc<GpuScene>>,
    pub(super) environment: Arc<GpuEnvironment>,
    pub(super) measured: Arc<Buffer>,
    /// Slug of the mode that `wanted` draws.
    pub(super) mode: String,
    /// The lights that `wanted` counts.
    pub(super) lights: LightSource,
    /// Whether the rectangle is one of them.
    pub(super) rect: bool,
}

/// The raw value under the mouse.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Hover {
    /// Pixels from the picture's left edge.
    pub(super) x: u32,
    /// Pixels from its upper edge.
    pub(super) y: u32,
    pub(super) value: [f32; 4],
}

/// A reload whose first frame is still to come.
pub(super) struct FirstFrame {
    pub(super) pipelines: Arc<PipelineSet>,
    pub(super) event: ReloadEvent,
}

/// The shader tree's state, for the panel.
#[derive(Default)]
pub(super) struct ShaderState {
    pub(super) tree: String,
    pub(super) compiling: bool,
    pub(super) last: Option<ReloadEvent>,
}

/// Everything behind the window.
pub(super) struct Document {
    pub(super) settings: Settings,
    pub(super) model: Model,
    pub(super) model_path: Option<PathBuf>,
    /// The model's files that are watched, or those of one that could not be loaded.
    pub(super) model_files: Vec<PathBuf>,
    pub(super) loading: bool,
    pub(super) load_ms: f64,
    pub(super) pipelines: Option<Arc<PipelineSet>>,
    pub(super) diagnostics: Vec<Diagnostic>,
    pub(super) shader: ShaderState,
    /// A message for a while, with its time.
    pub(super) notice: Option<(String, Instant)>,
    pub(super) hand: CameraHand,
    pub(super) mouse: Mouse,
    pub(super) hover: Option<Hover>,
    /// How many frames the picture on screen is the mean of.
    pub(super) accumulated: u32,
    /// The mode that the list was last scrolled to.
    pub(super) shown_in_list: String,
    pub(super) show_ui: bool,
    pub(super) quit: bool,
    pub(super) screenshot: bool,
    pub(super) events: bool,
    pub(super) start: Instant,
    pub(super) first_frame: Option<FirstFrame>,
    pub(super) scene: Option<Arc<GpuScene>>,
    pub(super) next_scene: Option<(Model, Arc<GpuScene>)>,
    pub(super) shown: Option<Shown>,
    pub(super) asked: Option<(Arc<PipelineSet>, Wanted)>,
    pub(super) ready: bool,
    pub(super) gpu: Arc<Gpu>,
    pub(super) layouts: Arc<SetLayouts>,
    pub(super) proxy: EventLoopProxy<Message>,
    pub(super) worker: Worker,
    pub(super) surroundings: Surroundings,
    pub(super) tree_watcher: Option<Watcher>,
    pub(super) model_watcher: Option<Watcher>,
    pub(super) allow_outside: bool,
    pub(super) ticket: u64,
    /// The model that was asked for last; `model_path` is the one on screen.
    pub(super) requested: Option<PathBuf>,
    pub(super) loaders: Vec<JoinHandle<()>>,
}

impl Drop for Document {
    fn drop(&mut self) {
        // The watcher sends to the worker, and no thread may still be inside the driver when the process ends.
        self.tree_watcher = None;
        for loader in self.loaders.drain(..) {
            let _ = loader.join();
        }
    }
}

/// Format of the window's HDR target: half floats hold every picture, at half the cost.
pub(super) const SCENE_FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

impl Document {
    pub(super) fn new(
        gpu: &Arc<Gpu>,
        layouts: &Arc<SetLayouts>,
        options: AppOptions,
        early: Early,
        proxy: &EventLoopProxy<Message>,
    ) -> Result<Self, GpuError> {
        // What most models have, built while the model loads.
        let likely =
            MaterialVariant { features: FEATURE_NORMAL_TEXTURE | FEATURE_PACKED_OCCLUSION, ..Default::default() };
        let needs = Needs {
            settings: options.settings.clone(),
            materials: BTreeSet::from([likely]),
            own_lights: 0,
            samples: headless::samples(gpu, &options.settings).unwrap_or(1),
            scene_format: SCENE_FORMAT,
        };
        let tree = options.source.clone();
        let lights = &options.settings.lights;
        let surroundings = Surroundings::new(gpu, lights.ambient_color.map(|c| c * lights.ambient_strength))?;
        let worker = Worker::start(gpu, layouts, options.source, needs, &options.compiler, proxy.clone());
        let mut document = Self {
            settings: options.settings,
            model: Model::default(),
            model_path: options.model.clone(),
            model_files: Vec::new(),
            loading: false,
            load_ms: 0.0,
            pipelines: None,
            diagnostics: Vec::new(),
            shader: ShaderState { compiling: true, ..Default::default() },
            notice: None,
            hand: CameraHand::default(),
            mouse: Mouse::default(),
            hover: None,
            accumulated: 1,
            shown_in_list: String::new(),
            show_ui: true,
            quit: false,
            screenshot: false,
            events: options.events,
            start: options.start,
            first_frame: None,
            scene: None,
            next_scene: None,
            shown: None,
            asked: None,
            ready: false,
            gpu: gpu.clone(),
            layouts: layouts.clone(),
            proxy: proxy.clone(),
            worker,
            surroundings,
            tree_watcher: None,
            model_watcher: None,
            allow_outside: options.allow_outside,
            ticket: 0,
            requested: None,
            loaders: Vec::new(),
        };
        document.watch_tree(&tree);
        document.requested = options.model;
        document.model_watcher = early.watcher;
        document.take_model(early.reading);
        Ok(document)
    }

    /// The shaders on screen.
    pub(super) fn shaders(&self) -> Option<&ShaderSet> {
        self.pipelines.as_ref().map(|p| &*p.shaders)
    }

    /// The debug mode that is set, as the tree describes it.
    pub(super) fn mode(&self) -> Option<&Mode> {
        self.shaders()?.modes.iter().find(|m| m.slug == self.settings.mode)
    }

    /// The mode of the picture on screen.
    fn shown_mode(&self) -> Option<&Mode> {
        let shown = self.shown.as_ref()?;
        shown.pipelines.shaders.modes.iter().find(|m| m.id == shown.wanted.mode)
    }

    /// The mode that is set, while the picture still shows another.
    fn next_mode(&self) -> Option<&Mode> {
        let shown = self.shown_mode()?;
        self.mode().filter(|m| m.slug != shown.slug)
    }

    /// What stands over the picture: its mode, and the one that is on its way. The plain picture needs no title.
    pub(super) fn title(&mut self) -> Option<String> {
        if self.next_mode().is_some() {
            // It may be complete by now; then the frame after this title shows it.
            self.shown();
        }
        let shown = self.shown_mode()?;
        match self.next_mode() {
            Some(next) => Some(format!("{}  ➡  {} …", shown.name, next.name)),
            None if self.accumulates() => Some(match self.accumulated {
                1 => format!("{}   1 frame", shown.name),
                frames => format!("{}   mean of {frames} frames", shown.name),
            }),
            None => Some(shown.name.clone()).filter(|_| shown.slug != "final"),
        }
    }

    /// Lets the lights go on orbiting for `seconds`.
    pub(super) fn turn_lights(&mut self, seconds: f32) {
        let lights = &mut self.settings.lights;
        if lights.spin == 0.0 {
            return;
        }
        for light in &mut lights.orbit {
            light.azimuth = (light.azimuth + lights.spin * seconds + 180.0).rem_euclid(360.0) - 180.0;
        }
    }

    /// Whether the picture moves by itself: the lights orbit, or a shader reads the time.
    pub(super) fn moves(&self) -> bool {
        self.settings.lights.spin != 0.0 || self.shaders().is_some_and(|s| s.animated)
    }

    /// Whether the picture is the mean of frames, so that each one more makes it better.
    pub(super) fn accumulates(&self) -> bool {
        self.shown.as_ref().is_some_and(|shown| shown.wanted.accumulates)
    }

    /// Tells the user something for a few seconds.
    pub(super) fn say(&mut self, text: impl Into<String>) {
        let text = text.into();
        eprintln!("specula: {text}");
        self.notice = Some((text, Instant::now()));
    }

    /// Looks at the whole model again.
    pub(super) fn frame_model(&mut self) {
        self.settings.camera.eye = None;
        self.settings.camera.target = None;
    }

    /// Whether the device draws faster than a screen shows, so that waiting for the screen saves work. A software device is
    /// slower than any screen, and has no frame to give away.
    pub(super) fn gpu_is_fast(&self) -> bool {
        self.gpu.info().kind != "cpu"
    }

    /// Name of the device, and its Vulkan version.
    pub(super) fn device(&self) -> String {
        let info = self.gpu.info();
        format!("{} · Vulkan {}", info.name, info.api)
    }

    /// Compiles everything again.
    pub(super) fn reload(&mut self) {
        self.shader.compiling = true;
        self.worker.change(Change::All, Instant::now());
    }

    /// Opens whatever was dropped on the window.
    pub(super) fn open_path(&mut self, path: PathBuf) {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match ending.as_str() {
            _ if path.is_dir() && is_specula_tree(&path) => {
                let source = Source::Disk(path.clone());
                self.watch_tree(&source);
                self.shader.compiling = true;
                self.worker.open_tree(source);
            }
            _ if path.is_dir() => self.say(format!(
                "{} is no Specula shader tree: it has no interface.glsl. `specula new DIR` writes one",
                path.display()
            )),
            "gltf" | "glb" => self.load_model(Some(path)),
            "hdr" | "exr" => self.settings.environment.name = path.display().to_string(),
            "binary" | "bin" => {
                self.settings.measured = path.display().to_string();
                self.settings.mode = "measured".into();
            }
            _ => self.say(format!(
                "{}: expected a .gltf or .glb model, an .hdr or .exr environment, a measured .binary or .bin, or a folder with a \
                 shader tree",
                path.display()
            )),
        }
    }

    /// Works out what the next frame is drawn with: what the user asks for once it is complete, what was shown before until then.
    pub(super) fn shown(&mut self) -> Option<Shown> {
        self.read_measured();
        if let Some(set) = self.pipelines.clone() {
            self.bake_if_needed(&set);
            let scene = self.dressed();
            let needs = Needs {
                settings: self.settings.clone(),
                materials: scene.as_ref().map(|s| s.variants().clone()).unwrap_or_default(),
                own_lights: scene.as_ref().map_or(0, |s| s.own_lights()),
                samples: headless::samples(&self.gpu, &self.settings).unwrap_or(1),
                scene_format: SCENE_FORMAT,
            };
            let wanted = needs.wanted(&set.shaders);
            self.worker.need(needs);
            let is_asked =
                |(asked, for_this): &(Arc<PipelineSet>, Wanted)| Arc::ptr_eq(asked, &set) && *for_this == wanted;
            if set.has(&wanted) {
                self.show(set, wanted, scene);
            } else if !self.asked.as_ref().is_some_and(is_asked) {
                self.worker.build(&set, &wanted);
                self.asked = Some((set, wanted));
            }
        }
        self.shown.clone()
    }

    /// The newest scene in the materials that are set; in its own when they cannot be made.
    fn dressed(&self) -> Option<Arc<GpuScene>> {
        let newest = self.next_scene.as_ref().map(|(model, scene)| (model, scene));
        let (model, scene) = newest.or(self.scene.as_ref().map(|scene| (&self.model, scene)))?;
        Some(scene.dressed(&self.gpu, &self.layouts, model, &self.settings).unwrap_or_else(|_| scene.clone()))
    }

    fn show(&mut self, pipelines: Arc<PipelineSet>, wanted: Wanted, scene: Option<Arc<GpuScene>>) {
        if let Some((model, scene)) = self.next_scene.take() {
            if self.settings.lights.source == LightSource::Model && model.lights.is_empty() {
                self.say(format!("warning: {} has no lights of its own for `--lights model`", model.name));
            }
            self.model = model;
            self.scene = Some(scene);
        }
        self.asked = None;
        let mode = self.settings.mode.clone();
        let environment = self.surroundings.baked.environment.clone();
        let measured = self.surroundings.measured.clone();
        let lights = self.settings.lights.source;
        let rect = self.settings.lights.rect.enabled;
        self.shown = Some(Shown { pipelines, wanted, scene, environment, measured, mode, lights, rect });
    }

    /// A frame with these pipelines is finished, `ms` after it was begun.
    pub(super) fn frame_done(&mut self, shown: Option<&Shown>, ms: f64) {
        let is_shown = |first: &mut FirstFrame| shown.is_some_and(|s| Arc::ptr_eq(&s.pipelines, &first.pipelines));
        if let Some(first) = self.first_frame.take_if(is_shown) {
            self.emit_reload(ReloadEvent { first_frame_ms: ms, ..first.event });
        }
        if !self.ready && self.scene.is_some() {
            self.ready = true;
            // There already; what is built after it is what is likely next.
            shown.inspect(|s| self.worker.build(&s.pipelines, &s.wanted));
            let ms = self.start.elapsed().as_secs_f64() * 1e3;
            emit(self.events, &Event::Ready { device: &self.gpu.info().name, ms });
        }
    }

    /// Whether the time of the next frame is of interest: it is the first of a generation, or of the model.
    pub(super) fn times_next_frame(&self) -> bool {
        self.first_frame.is_some() || (!self.ready && self.scene.is_some())
    }

    fn watch_tree(&mut self, source: &Source) {
        let Some(root) = source.root().map(Path::to_owned) else {
            self.tree_watcher = None;
            return;
        };
        let send = self.worker.changes();
        let base = root.clone();
        let on_batch = move |batch: Batch| {
            let relative = batch.paths.iter().filter_map(|p| p.strip_prefix(&base).ok());
            let paths = relative.filter_map(|p| TreePath::parse(&p.to_string_lossy())).collect();
            send(Change::Paths(paths), batch.first_event);
        };
        match Watcher::new(Some(&root), &[], on_batch) {
            Ok(watcher) => self.tree_watcher = Some(watcher),
            Err(error) => self.say(error.to_string()),
        }
    }
}
