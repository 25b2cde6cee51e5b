//! The measurer measures the BRDF of a pixel's material, for the inspector: with the newest shaders, and with those before the last edit.
//! The newest request wins.

use std::sync::Arc;
use std::time::Instant;

use super::message::{Message, MessageSender, TaskKind};
use super::newest::{Newest, Turn};
use super::results::MeasuredCurves;
use crate::gpu::Gpu;
use crate::measure::{BrdfMeter, Curves, Material, prepare};
use crate::settings::Settings;
use crate::shader::{Compiler, ShaderSet, Source};

/// Request for curves.
#[derive(Clone)]
pub(crate) struct CurvesRequest {
    /// The newest shaders, and the previous ones.
    pub(crate) shaders: [Option<Arc<ShaderSet>>; 2],
    /// The tree that the measuring stages come from.
    pub(crate) tree: Source,
    pub(crate) settings: Settings,
    pub(crate) material: Material,
}

/// The thread. Dropping this ends its work before the next step and waits for that.
pub(crate) struct Measurer {
    gpu: Arc<Gpu>,
    thread: Newest<CurvesRequest>,
}

impl Measurer {
    pub(crate) fn new(gpu: &Arc<Gpu>, sender: &MessageSender) -> Self {
        Self { gpu: gpu.clone(), thread: Newest::new(TaskKind::Measurer, sender) }
    }

    /// Starts a measurement and drops the previous request. Returns the number of the request.
    pub(crate) fn measure(&mut self, compiler: &Arc<Compiler>, request: CurvesRequest) -> u64 {
        self.thread.request(request, || {
            let mut meters = BrdfMeters { gpu: self.gpu.clone(), compiler: compiler.clone(), made: Vec::new() };
            move |sender, turn, request| {
                let measured = meters.measure(turn, &request);
                measured.into_iter().for_each(|measured| sender.send(Message::Curves(Box::new(measured))));
            }
        })
    }
}

/// The compiled measuring stages of the newest shaders and of the previous ones.
struct BrdfMeters {
    gpu: Arc<Gpu>,
    compiler: Arc<Compiler>,
    /// By shaders, with the settings that their tables were baked for.
    made: Vec<(Arc<ShaderSet>, (Settings, BrdfMeter))>,
}

impl BrdfMeters {
    /// `None` without shaders, or if a newer request has come.
    fn measure(&mut self, turn: &Turn<'_>, request: &CurvesRequest) -> Option<MeasuredCurves> {
        let start = Instant::now();
        let [now, before] = &request.shaders;
        self.made.retain(|(of, _)| request.shaders.iter().flatten().any(|kept| Arc::ptr_eq(kept, of)));
        let now = self.curves(now.as_ref()?, request);
        let before = before.as_ref().filter(|_| !turn.is_superseded()).map(|before| self.curves(before, request));
        let ms = start.elapsed().as_secs_f64() * 1e3;
        (!turn.is_superseded()).then(|| MeasuredCurves {
            number: turn.number,
            now,
            before: before.and_then(Result::ok),
            ms,
        })
    }

    fn curves(&mut self, shaders: &Arc<ShaderSet>, request: &CurvesRequest) -> Result<Curves, String> {
        // Only the author's constants and parameters count.
        let settings = Settings { shader: request.settings.shader.clone(), ..Settings::default() };
        let made = self.made.iter_mut().find(|(of, _)| Arc::ptr_eq(of, shaders)).map(|(_, made)| made);
        let meter = match made {
            Some((of, meter)) if *of == settings => meter,
            Some(made) => {
                let meter = made.1.with(&settings).map_err(|error| error.to_string())?;
                *made = (settings, meter);
                &mut made.1
            }
            None => {
                let meter = prepare(&self.gpu, &self.compiler, &request.tree, &shaders.texts, &settings)?;
                self.made.push((shaders.clone(), (settings, meter)));
                match self.made.last_mut() {
                    Some((_, (_, meter))) => meter,
                    None => return Err("nothing was compiled".into()),
                }
            }
        };
        Curves::measure(meter, &request.material).map_err(|error| error.to_string())
    }
}
