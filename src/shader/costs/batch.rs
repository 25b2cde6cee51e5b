//! Functions of a stage whose calls and results are recorded together.

use std::sync::Arc;

use super::{Calls, CostStage, NAMES, with_address};
use crate::shader::spirv::cost::{StageFunction, functions, groups, groups_of, recording};
use crate::shader::trace::{EXTENSIONS, compile_listening};
use crate::shader::{ShaderSet, StageKind};

/// Most functions of a batch.
const BATCH: usize = 8;
/// Words of the buffer for the stage and for each function.
const SLOT: usize = 6;

/// Some functions of a stage, and the layout of the buffer that records them.
pub struct Batch<'a> {
    stage: &'a CostStage<'a>,
    members: Vec<usize>,
    functions: Vec<StageFunction>,
    /// The first group of numbers of each function.
    first: Vec<u32>,
    groups: u32,
}

/// Record of a function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recorded {
    /// Its place among the functions of the stage.
    pub function: usize,
    /// How often it was called.
    pub calls: Calls,
    /// The numbers that it has returned.
    pub numbers: Vec<u32>,
}

impl<'a> Batch<'a> {
    /// The functions of a stage that can be left out, of those with these places, in batches that are recorded together: a driver takes
    /// minutes for a stage that records all of them.
    pub fn all(stage: &'a CostStage<'a>, wanted: &[usize]) -> Vec<Self> {
        let is_measured = |at: &usize| stage.functions.get(*at).is_some_and(|function| function.lack.is_none());
        let measured: Vec<usize> = wanted.iter().copied().filter(is_measured).collect();
        measured.chunks(BATCH).map(|members| Self::new(stage, members)).collect()
    }

    fn new(stage: &'a CostStage<'a>, members: &[usize]) -> Self {
        let functions: Vec<StageFunction> = members.iter().map(|at| stage.functions[*at].clone()).collect();
        let (first, groups) = groups(&functions);
        Self { stage, members: members.to_vec(), functions, first, groups: groups.max(1) }
    }

    /// Bytes of the buffer.
    pub fn bytes(&self) -> u64 {
        4 * (self.numbers_at() as u64 + 4 * u64::from(self.groups))
    }

    /// The first word of the results.
    fn numbers_at(&self) -> usize {
        (SLOT * (self.members.len() + 1)).next_multiple_of(4)
    }

    /// The content of the buffer before the first draw. With the buffer of the first draw, that before the second one, which keeps the
    /// results of the invocations that the first has found.
    pub fn buffer(&self, found: Option<&[u32]>) -> Vec<u32> {
        let mut words = vec![0; (self.bytes() / 4) as usize];
        let own = self.first.iter().copied().zip(self.functions.iter().map(groups_of));
        for (slot, (first, count)) in std::iter::once((0, 0)).chain(own).enumerate() {
            let wanted = found.and_then(|found| found.get(SLOT * slot + 2)).copied().unwrap_or(u32::MAX);
            words[SLOT * slot..][..SLOT].copy_from_slice(&[0, 0, u32::MAX, wanted, first, count]);
        }
        words
    }

    /// The invocations of the stage, and what was recorded of each function, by the words of the buffer after the second draw.
    pub fn recorded(&self, words: &[u32]) -> (u32, Vec<Recorded>) {
        let slot = |at: usize| Calls { calls: words[SLOT * at], invocations: words[SLOT * at + 1] };
        let recorded = self.members.iter().enumerate().map(|(at, member)| {
            let start = self.numbers_at() + 4 * self.first[at] as usize;
            let numbers = words[start..][..4 * groups_of(&self.functions[at]) as usize].to_vec();
            Recorded { function: *member, calls: slot(at + 1), numbers }
        });
        (slot(0).invocations, recorded.collect())
    }

    /// The shaders with a stage that records to the buffer at this address. `size`: width and height of the image that it draws.
    ///
    /// # Errors
    /// A message why the stage cannot be recorded.
    pub fn shaders(&self, address: u64, (width, height): (u32, u32)) -> Result<Arc<ShaderSet>, String> {
        let CostStage { shaders, stage, tools, functions: known, .. } = self.stage;
        let lacks = || format!("the functions of {} cannot be recorded", stage.path);
        let (counts, key) = invocation_texts(stage.kind);
        let (slots, groups) = (self.members.len() + 1, self.groups as usize);
        let number = |number: usize| format!("{number}u");
        let all = |name: &str, count: usize| (0..count).map(|at| format!("{name}{at}")).collect::<Vec<_>>().join(", ");
        let [count_names, value_names] = [all(NAMES.count, slots), all(NAMES.values, groups)];
        let text = include_str!("costs.glsl")
            .replace("SPECULA_DECLARED", &format!("uint {count_names};\nuvec4 {value_names};"))
            .replace("SPECULA_ALL_COUNTS", &count_names)
            .replace("SPECULA_ALL_VALUES", &value_names)
            .replace("SPECULA_SLOTS", &number(slots))
            .replace("SPECULA_GROUPS", &number(groups))
            .replace("SPECULA_NUMBERS", &number(self.numbers_at()))
            .replace("SPECULA_COUNTS", counts)
            .replace("SPECULA_KEY", key)
            .replace("SPECULA_WIDTH", &number(width as usize))
            .replace("SPECULA_HEIGHT", &number(height as usize));
        let text = with_address(&text, [address as u32, (address >> 32) as u32]);
        let (_, words) = compile_listening(shaders, &stage.path, *tools, (&text, EXTENSIONS))?;
        let all = functions(&words, &NAMES).ok_or_else(lacks)?;
        // The texts differ behind the author's code alone, so the functions are the same, with other ids.
        if !all.iter().map(|of| &of.signature).eq(known.iter().map(|of| &of.signature)) {
            return Err(lacks());
        }
        let of_module: Vec<StageFunction> = self.members.iter().map(|at| all[*at].with_lack(None)).collect();
        let words = recording(&words, &of_module, &NAMES).ok_or_else(lacks)?;
        Ok(self.stage.with_module(words))
    }
}

/// Whether an invocation of a stage counts, and a number of its own: the smaller, the nearer to the middle of the picture.
fn invocation_texts(kind: StageKind) -> (&'static str, &'static str) {
    match kind {
        // The pixels around a triangle run along for derivatives.
        StageKind::Fragment => (
            "!gl_HelperInvocation",
            "uint(min(distance(gl_FragCoord.xy, vec2(SPECULA_WIDTH, SPECULA_HEIGHT) * 0.5), 1023.0)) << 22 \
             | (uint(gl_FragCoord.y) * SPECULA_WIDTH + uint(gl_FragCoord.x)) & 0x3fffffu",
        ),
        StageKind::Compute => ("true", "gl_GlobalInvocationID.y << 16 | gl_GlobalInvocationID.x"),
        StageKind::Vertex => ("true", "uint(gl_VertexIndex)"),
        StageKind::TessellationControl | StageKind::TessellationEvaluation => ("true", "uint(gl_PrimitiveID)"),
        StageKind::Geometry => ("true", "uint(gl_PrimitiveIDIn)"),
        StageKind::Task | StageKind::Mesh => ("true", "gl_WorkGroupID.x << 8 | gl_LocalInvocationIndex"),
    }
}
