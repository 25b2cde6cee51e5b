//! The last step before the driver: specialized, optimized modules whose loops end, and the diagnostic of a loop that did not.
//!
//! A module is prepared in these steps, in some 6 ms for the picture's 29,000 words:
//!
//! 1. `spirv::specialize` sets the constants and drops the branches that they decide against.
//! 2. `spirv::loops` bounds loops.
//! 3. `spirv/hits.rs` copies the functions that path tracing calls at a hit, where a hook needs neighboring
//!    pixels.
//! 4. `spirv::optimize` inlines functions and removes what is computed twice or never used.
//!
//! An endless loop is found in the buffer that a submission copies to the CPU (`gpu/commands/slot.rs`), once its fence
//! has signaled. The name in it is a hash of the module and the loop. [`endless_loop`] finds the loop and compiles its
//! stage once more with line information: on a thread in the window, in place without one, where the diagnostic is the
//! error of `Headless::render`. A bake fails with `GpuError::EndlessLoop` and is not cached. After a change, the window
//! draws up to two more frames to learn whether its loops ended; a frame whose loops end removes the diagnostic.

use std::sync::Arc;

use crate::gpu::{Gpu, GpuError, ResourceUsage, ShaderModule, fault};
use crate::interface::{self, ALPHA_BLEND, FLAG_NOT_FINITE, MODE_FINAL, SPEC_ALPHA_MODE, SPEC_MODE};
use crate::shader::contract::access::resource_of;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::loops::{Bounds, LoopPlace, Overrun};
use crate::shader::spirv::reach::{Used, reached};
use crate::shader::spirv::uses::used_bytes;
use crate::shader::spirv::{self, Finished, Module, specialize_several};
use crate::shader::{Compiler, Diagnostic, Severity, ShaderSet, Source, Stage, StageKind, TreePath};

/// Loop iterations that a pixel or a vertex may take. A GPU runs some 2000 invocations per multiprocessor at a time, so on a GPU
/// of any size the first of them take between a tenth of a second (short iterations) and a second (long ones).
const ROUNDS: u32 = 1 << 18;
/// The limit for an invocation of a bake, of which there are few.
const ROUNDS_OF_BAKES: u32 = 1 << 20;
/// The limit on a software device. Mesa's lavapipe ends all loops after 65,535 iterations, uncounted loops included.
const ROUNDS_ON_CPU: u32 = 49_152;
/// The limit for several modes in one stage.
const MOST_ON_CPU: u32 = 60_000;
/// Iterations of each invocation that begins after another has exceeded its limit.
const ROUNDS_AFTER: u32 = 1024;
const ROUNDS_AFTER_ON_CPU: u32 = 256;
/// Scene color of a pixel whose loops were cut short. `is_cut_short` in common/pixel.glsl knows it by its sign and flag, and
/// the tone map shows it as magenta.
const MARK: [f32; 4] = [60_000.0, -60_000.0, 60_000.0, 1.0 + FLAG_NOT_FINITE as f32];
/// The same color in the LDR output.
const MARK_ON_DISPLAY: [f32; 4] = [1.0, 0.0, 1.0, 1.0];

fn rounds(gpu: &Gpu, kind: StageKind) -> u32 {
    match kind {
        _ if gpu.info().kind == "cpu" => ROUNDS_ON_CPU,
        StageKind::Compute => ROUNDS_OF_BAKES,
        _ => ROUNDS,
    }
}

/// The module of a stage, specialized with these constants, with bounded loops, optimized. `is_on_display`: its color is shown
/// unchanged, after the tone map. With `draws_by_index`, it finds its draw in a buffer.
pub(super) fn shader_module(
    gpu: &Arc<Gpu>,
    stage: &Stage,
    constants: &[(u32, u32)],
    is_on_display: bool,
    draws_by_index: bool,
) -> Result<Arc<ShaderModule>, GpuError> {
    bounded_module(gpu, stage, (stage.specialize(constants), 1), constants, is_on_display, draws_by_index)
}

/// The module of a fragment stage that computes several `modes`, each for a target of its own. `None` if the stage does not
/// depend on the mode, or not in a way that allows this.
pub(super) fn module_of_modes(
    gpu: &Arc<Gpu>,
    stage: &Stage,
    constants: &[(u32, u32)],
    modes: &[u32],
    draws_by_index: bool,
) -> Option<Result<Arc<ShaderModule>, GpuError>> {
    let words = specialize_several(&stage.spirv, constants, SPEC_MODE, modes)?;
    Some(bounded_module(gpu, stage, (words, modes.len() as u32), constants, false, draws_by_index))
}

/// A module of `words` that computes this many modes, each with the iteration limit of a single one.
fn bounded_module(
    gpu: &Arc<Gpu>,
    stage: &Stage,
    (words, modes): (Vec<u32>, u32),
    constants: &[(u32, u32)],
    is_on_display: bool,
    draws_by_index: bool,
) -> Result<Arc<ShaderModule>, GpuError> {
    let (path, kind) = (stage.path.as_str(), stage.kind);
    let stores = match kind {
        StageKind::Compute => true,
        StageKind::Fragment => gpu.graphics_stores().1,
        _ => gpu.graphics_stores().0,
    };
    let buffer = interface::LOOPS[usize::from(kind == StageKind::Compute)];
    let is = |id: u32, value: u32| constants.contains(&(id, value));
    let mark = match kind {
        kind if kind != StageKind::Fragment => None,
        _ if is_on_display => Some(MARK_ON_DISPLAY),
        // The blend unit reads alpha as coverage.
        _ if is(SPEC_ALPHA_MODE, ALPHA_BLEND) && is(SPEC_MODE, MODE_FINAL) => None,
        _ => Some(MARK),
    };
    let most = if gpu.info().kind == "cpu" { MOST_ON_CPU } else { u32::MAX };
    let bounds = Bounds {
        rounds: (rounds(gpu, kind) * modes).min(most),
        rounds_after: if gpu.info().kind == "cpu" { ROUNDS_AFTER_ON_CPU } else { ROUNDS_AFTER },
        report: stores.then_some(buffer),
        mark,
    };
    fault::take_module(&words);
    let Finished { words, unoptimized, is_bounded } = spirv::finish(words, &stage.spirv, &bounds, draws_by_index);
    tracing::debug!(
        "{path}: {unoptimized} words, optimized {}, {}",
        words.len(),
        if is_bounded { "has loops that count their rounds" } else { "all loops are counted" }
    );
    let usage = Module::parse(&words).map(|module| usage(&module)).unwrap_or_default();
    ShaderModule::optimized(gpu, path, (&words, unoptimized), is_bounded && stores, usage)
}

fn usage(module: &Module) -> ResourceUsage {
    let reached = reached(module);
    ResourceUsage {
        frame_bindings: Used::bindings(&reached, interface::SET_FRAME),
        frame_bytes: used_bytes(module, interface::SET_FRAME, interface::BINDING_FRAME),
        pass_bindings: Used::bindings(&reached, interface::SET_PASS),
        resources: reached.into_iter().filter_map(resource_of).collect(),
    }
}

/// The diagnostic of a loop that did not end: `words` name it, in one of the stages of `shaders`. Compiles the stage again to
/// find the loop's line. `None` if the words belong to other shaders.
pub fn endless_loop(
    gpu: &Gpu,
    [one, together]: [u32; 2],
    shaders: &ShaderSet,
    compiler: &Compiler,
    source: &Source,
) -> Option<Diagnostic> {
    let overrun = Overrun { one, together };
    let find = |stage: &Arc<Stage>| Some((stage.clone(), LoopPlace::find(overrun, &stage.spirv)?));
    let (stage, place) = shaders.stages.values().find_map(find)?;
    let rounds = rounds(gpu, stage.kind);
    let snapshot = Snapshot::new(source);
    let diagnostic = match &place {
        LoopPlace { number: Some(_), .. } => {
            let lines = compiler.compile_with_lines(&snapshot, &stage.path);
            let line = lines.and_then(|words| place.line(&words));
            let message = match place.is_finite {
                true => format!("this loop takes more than {rounds} iterations"),
                false => format!("this loop did not end ({rounds} iterations)"),
            };
            match line {
                Some((file, line)) => {
                    let path = TreePath::from(file.as_str());
                    let text = snapshot.read(&path).unwrap_or_default();
                    let excerpt = text.lines().nth(line as usize - 1);
                    Diagnostic::error(snapshot.display_path(&path), message).on_line(line, excerpt)
                }
                None => {
                    let function = place.function_in_glsl();
                    let message = format!("a loop in `{function}` did not end ({rounds} iterations)");
                    Diagnostic::error(snapshot.display_path(&stage.path), message)
                }
            }
        }
        LoopPlace { number: None, .. } => {
            let message = format!("the loops of this stage did not end together ({rounds} iterations)");
            Diagnostic::error(snapshot.display_path(&stage.path), message)
        }
    };
    let diagnostic = source.explained(diagnostic);
    Some(match place.is_finite {
        // There is a picture to show.
        true => Diagnostic { severity: Severity::Warning, ..diagnostic }.with_help(
            "it was cut short: pixels where it was are magenta. Let it take fewer iterations, counted with the loops around it",
        ),
        false => diagnostic.with_help(
            "it was cut short, so the result is wrong. Repair its condition, or set back the value that it depends on",
        ),
    })
}
