//! Measures what each function of a stage costs: the frame is drawn with and without it, in turn.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::pixel_tracer::TraceTools;
use super::stage_costs::{FunctionCost, StageCosts};
use super::stopwatch::{Contest, Stopwatch};
use super::{Headless, HeadlessError, stage_plan};
use crate::frame::FrameState;
use crate::frame::stages::DEFORM;
use crate::gpu::{Buffer, Gpu, Memory, SetLayouts, one_shot, vk};
use crate::pipeline::{PipelineSet, StageReport, figures};
use crate::render::{BoundFrame, Redraw};
use crate::shader::costs::{Batch, Calls, CostStage, Lack, NamedFunction};
use crate::shader::graph::RenderPhase;
use crate::shader::{GraphPass, ShaderSet, StageKind};
use crate::statistics::Difference;

/// The passes that draw the model.
const OF_MODEL: [&str; 2] = ["behind", "model"];

/// A frame, and whose costs are measured.
pub struct CostRequest<'a> {
    /// The state of the frame with other modules of its stages.
    pub state: &'a dyn Fn(&Arc<ShaderSet>) -> Arc<FrameState>,
    /// The pipelines of its shaders.
    pub set: &'a Arc<PipelineSet>,
    /// The stage; `None` for the one that draws the picture.
    pub stage: Option<&'a str>,
    /// The names of the functions; empty for all.
    pub functions: &'a [String],
    /// Most pairs of frames for a function.
    pub most: usize,
}

/// Measures costs.
pub struct CostMeter {
    gpu: Arc<Gpu>,
    stopwatch: Stopwatch,
}

impl CostMeter {
    /// Creates the view.
    ///
    /// # Errors
    /// No memory left.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>) -> Result<Self, HeadlessError> {
        Ok(Self { gpu: gpu.clone(), stopwatch: Stopwatch::new(gpu, layouts)? })
    }

    /// Draws two frames in turn: see [`Stopwatch::compare`].
    ///
    /// # Errors
    /// A device error; canceled.
    pub fn compare(&mut self, contest: &Contest<'_>) -> Result<Option<Difference>, HeadlessError> {
        self.stopwatch.compare(contest)
    }

    /// Measures the functions of a stage. `progress` gets the number of the function, how many there are, and its name.
    ///
    /// # Errors
    /// The frame has no such stage or function, it cannot be measured, a device error; canceled.
    pub fn measure(
        &mut self,
        request: &CostRequest<'_>,
        tools: &mut TraceTools<'_>,
        progress: &mut dyn FnMut(usize, usize, &str),
    ) -> Result<StageCosts, HeadlessError> {
        let shaders = &request.set.shaders;
        let state = (request.state)(shaders);
        let path = chosen(&state, request.stage)?;
        self.check_stores(shaders, &path)?;
        let constants = constants_of(&state, &path);
        let constants: Vec<&[(u32, u32)]> = constants.iter().map(Vec::as_slice).collect();
        let stage = CostStage::new(shaders, &path, (tools.compiler, tools.source), &constants);
        let stage = stage.map_err(HeadlessError::Settings)?;
        let all = stage.functions();
        if let Some(unknown) = request.functions.iter().find(|name| !all.iter().any(|(of, _)| has_name(of, name))) {
            let message = format!(
                "{} has no function {unknown} that is compiled and that the author wrote",
                shaders.name_of(&path)
            );
            return Err(HeadlessError::Settings(message));
        }
        let wanted: Vec<usize> = (0..all.len())
            .filter(|at| shaders.is_authored(&all[*at].0.file) && is_named(&all[*at].0, request.functions))
            .collect();
        let Recording { results, invocations, calls } = self.record(request, tools, (&stage, &wanted), state.size)?;
        let mut run = Run { meter: self, request, tools, stage: &stage, path: &path, address: results.address() };
        let (whole, base) = run.bound(None)?;
        let base_report = run.report(&whole, &state)?;
        let passes = passes_of(&state, &path);
        let (mut measured, mut left_out) = (Vec::new(), Vec::new());
        let is_measured = |at: &usize| calls.get(at).is_some_and(|calls| calls.calls > 0);
        let count = wanted.iter().filter(|at| is_measured(at)).count();
        let mut number = 0;
        for index in wanted {
            let (function, lack) = all[index].clone();
            let lack = lack.or_else(|| (!is_measured(&index)).then_some(Lack::NotCalled));
            if let Some(lack) = lack {
                left_out.push((function, lack));
                continue;
            }
            progress(number, count, &function.signature);
            number += 1;
            let (set, other) = run.bound(Some(index))?;
            let report = run.report(&set, &state)?;
            let words = |report: &StageReport| report.largest.as_ref().map_or(0, |largest| largest.words);
            if words(&report) > words(&base_report) + stage.allowance(index) {
                left_out.push((function, Lack::Decides));
                continue;
            }
            match run.compare([&base, &other], &passes)? {
                Some(difference) => {
                    let figures = figures(&report, Some(&base_report));
                    measured.push(FunctionCost { function, calls: calls[&index], difference, figures });
                }
                None => left_out.push((function, Lack::Endless)),
            }
        }
        // A device is slower while it wakes up.
        let [stage_ms, frame_ms] = run.typical_ms(&base, &passes)?;
        measured.sort_by(|a, b| b.ms().total_cmp(&a.ms()));
        Ok(StageCosts { stage: path, stage_ms, frame_ms, invocations, functions: measured, left_out })
    }

    /// Whether the stage can write what it returns.
    fn check_stores(&self, shaders: &ShaderSet, path: &str) -> Result<(), HeadlessError> {
        let (vertex, fragment) = self.gpu.graphics_stores();
        let can_write = match shaders.stages.get(path).map(|stage| stage.kind) {
            Some(StageKind::Fragment) => fragment,
            Some(StageKind::Compute) => true,
            _ => vertex,
        };
        let name = &self.gpu.info().name;
        match can_write {
            true => Ok(()),
            false => Err(HeadlessError::Settings(format!(
                "{name} cannot write buffers from {}, which this needs",
                shaders.name_of(path)
            ))),
        }
    }

    /// Draws the frame with stages that record what these functions return.
    fn record(
        &mut self,
        request: &CostRequest<'_>,
        tools: &mut TraceTools<'_>,
        (stage, wanted): (&CostStage<'_>, &[usize]),
        size: (u32, u32),
    ) -> Result<Recording, HeadlessError> {
        use vk::BufferUsageFlags as Usage;
        let usage = Usage::STORAGE_BUFFER | Usage::SHADER_DEVICE_ADDRESS;
        let (mut invocations, mut calls, mut numbers) = (0, BTreeMap::new(), Vec::new());
        for batch in Batch::all(stage, wanted) {
            let buffer = Buffer::new(&self.gpu, "costs", batch.bytes(), usage, Memory::Readback)?;
            let shaders = batch.shaders(buffer.address(), size).map_err(HeadlessError::Settings)?;
            let (_set, frame) = bound(request, tools, &shaders)?;
            let first = self.record_once(&frame, &buffer, &batch.buffer(None))?;
            let second = self.record_once(&frame, &buffer, &batch.buffer(Some(&first)))?;
            let (of_stage, recorded) = batch.recorded(&second);
            invocations = of_stage;
            for of in recorded {
                calls.insert(of.function, of.calls);
                numbers.push((of.function, of.numbers));
            }
        }
        // Results that are read from the memory of the CPU would take longer than many a function.
        let words = bytes_of(&stage.results(&numbers));
        let size = words.len() as u64;
        let staging = Buffer::new(&self.gpu, "staging", size, Usage::TRANSFER_SRC, Memory::Upload)?;
        let results = Buffer::new(&self.gpu, "results", size, usage | Usage::TRANSFER_DST, Memory::Device)?;
        staging.write(0, &words);
        one_shot(&self.gpu, |encoder| {
            encoder.copy_buffer(&staging, 0, &results, 0, size);
            encoder.copies_done();
            Ok(())
        })?;
        Ok(Recording { results, invocations, calls })
    }

    /// Draws a frame whose stage records to a buffer with this content. Returns what the buffer has then.
    fn record_once(
        &mut self,
        frame: &BoundFrame,
        buffer: &Arc<Buffer>,
        words: &[u32],
    ) -> Result<Vec<u32>, HeadlessError> {
        buffer.write(0, &bytes_of(words));
        let own = &mut self.stopwatch.own;
        own.view.forget();
        own.view.restart_passes();
        own.view.restart_mean();
        own.draw(frame, Redraw::Always, |_, encoder, _| {
            encoder.keep(buffer);
            encoder.buffers_written();
            Ok(())
        })?;
        Ok(buffer.read().as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect())
    }
}

/// Results that the functions of a stage have returned.
struct Recording {
    /// The numbers, on the device.
    results: Arc<Buffer>,
    /// The invocations of the stage.
    invocations: u32,
    /// The calls of each function, by its place.
    calls: BTreeMap<usize, Calls>,
}

fn bytes_of(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// The measurement of a stage that is under way.
struct Run<'a, 'b> {
    meter: &'a mut CostMeter,
    request: &'a CostRequest<'a>,
    tools: &'a mut TraceTools<'b>,
    stage: &'a CostStage<'a>,
    path: &'a str,
    address: u64,
}

impl Run<'_, '_> {
    /// The frame without a function, and its pipelines.
    fn bound(&mut self, function: Option<usize>) -> Result<(Arc<PipelineSet>, BoundFrame), HeadlessError> {
        let shaders = self.stage.without(function, self.address).map_err(HeadlessError::Settings)?;
        bound(self.request, self.tools, &shaders)
    }

    /// The numbers of the stage in a set, with those that the driver tells.
    fn report(&self, set: &PipelineSet, state: &FrameState) -> Result<StageReport, HeadlessError> {
        while set.ask_driver(&state.pipelines)?.is_some() {}
        Ok(set.report(&state.pipelines).remove(self.path).unwrap_or_default())
    }

    fn compare(&mut self, frames: [&BoundFrame; 2], passes: &[String]) -> Result<Option<Difference>, HeadlessError> {
        let (most, is_canceled) = (self.request.most, self.tools.is_canceled);
        self.meter.stopwatch.compare(&Contest { frames, passes, most, is_canceled })
    }

    /// The median times of these passes and of the whole frame.
    fn typical_ms(&mut self, frame: &BoundFrame, passes: &[String]) -> Result<[f64; 2], HeadlessError> {
        let stopwatch = &mut self.meter.stopwatch;
        stopwatch.times(frame, passes)?;
        let times = (0..5).map(|_| stopwatch.times(frame, passes)).collect::<Result<Vec<_>, HeadlessError>>()?;
        Ok([0, 1].map(|part| {
            let mut sorted: Vec<f64> = times.iter().map(|both| both[part]).collect();
            sorted.sort_by(f64::total_cmp);
            sorted[sorted.len() / 2]
        }))
    }
}

/// The frame with these shaders, a variant of those of the request, and its pipelines.
fn bound(
    request: &CostRequest<'_>,
    tools: &mut TraceTools<'_>,
    shaders: &Arc<ShaderSet>,
) -> Result<(Arc<PipelineSet>, BoundFrame), HeadlessError> {
    if (tools.is_canceled)() {
        return Err(HeadlessError::Canceled);
    }
    let state = (request.state)(shaders);
    let (set, _) = request.set.variant(shaders.clone(), &state.pipelines)?;
    let frame = tools.resources.bind_variant(&set, &state)?;
    let frame = frame.ok_or_else(|| HeadlessError::Settings("the light of the picture is being baked".to_owned()))?;
    Ok((set, frame))
}

/// The stage of a frame that is measured.
fn chosen(state: &FrameState, wanted: Option<&str>) -> Result<String, HeadlessError> {
    let Some(wanted) = wanted else { return stage_plan::choose(state, None, &[]) };
    let all = state.pipelines.stages();
    let shaders = &state.shaders;
    match shaders.stage_named(wanted).filter(|stage| all.contains(*stage)) {
        Some(stage) => Ok(stage.to_owned()),
        None => {
            let list = all.iter().map(|stage| shaders.name_of(stage)).collect::<Vec<_>>().join(", ");
            Err(HeadlessError::Settings(format!("the picture has no stage {wanted}; it has {list}")))
        }
    }
}

/// The lists of constants with which a frame has a stage.
fn constants_of(state: &FrameState, stage: &str) -> BTreeSet<Vec<(u32, u32)>> {
    let request = &state.pipelines;
    let keys = request.keys().filter(|key| key.stages().any(|of| of == stage));
    let mut constants: BTreeSet<Vec<(u32, u32)>> = keys.map(|key| key.specialization.to_vec()).collect();
    if request.compute_stages().any(|of| of == stage) {
        constants.insert(request.pass_constants().to_vec());
    }
    constants
}

/// The passes of a frame that run a stage, as the device's times name them.
fn passes_of(state: &FrameState, stage: &str) -> Vec<String> {
    let request = &state.pipelines;
    if stage == DEFORM {
        return vec!["deform".to_owned()];
    }
    let model = request.model_pass().filter(|_| request.draws_model);
    if model.is_some_and(|pass| pass.stages().any(|of| of == stage)) {
        return OF_MODEL.map(str::to_owned).to_vec();
    }
    let passes = request.passes.iter().filter(|pass| pass.stages().any(|of| of == stage));
    let name = |pass: &GraphPass| match pass.phase {
        RenderPhase::Tonemap => "tone map".to_owned(),
        RenderPhase::Mean => "accumulate".to_owned(),
        _ => pass.name().to_owned(),
    };
    passes.map(|pass| name(pass)).collect()
}

/// Whether a function has the name, with or without its parameters.
fn has_name(function: &NamedFunction, name: &str) -> bool {
    function.signature == name || function.signature.split('(').next() == Some(name)
}

fn is_named(function: &NamedFunction, names: &[String]) -> bool {
    names.is_empty() || names.iter().any(|name| has_name(function, name))
}

impl Headless {
    /// Measures what the functions of a stage cost in the first frame of the sequence: see [`CostMeter::measure`].
    ///
    /// # Errors
    /// As [`CostMeter::measure`].
    pub fn costs(
        &mut self,
        (stage, functions): (Option<&str>, &[String]),
        most: usize,
        progress: &mut dyn FnMut(usize, usize, &str),
    ) -> Result<StageCosts, HeadlessError> {
        self.finish_or_fail()?;
        self.provide()?;
        let changed = || HeadlessError::Settings("the shaders have changed".to_owned());
        let set = self.resources.pipelines().cloned().ok_or_else(changed)?;
        let target = self.frame_state()?.pipelines.target;
        let mut meter = CostMeter::new(&self.gpu, &self.layouts)?;
        let (session, clock, size) = (&self.session, self.clock, self.size);
        let state = |shaders: &Arc<ShaderSet>| session.frame_state_of(shaders, clock, size, target);
        let request = CostRequest { state: &state, set: &set, stage, functions, most };
        let mut tools = TraceTools::new(&mut self.resources, &self.reloader);
        meter.measure(&request, &mut tools, progress)
    }
}
