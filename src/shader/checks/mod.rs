//! Finds the operations of a frame's stages whose result GLSL leaves open, and the author's assertions that fail and values that are
//! printed, with how often, where first, and with which operands.
//!
//! Each stage is compiled once more with line information, and its module is instrumented (`spirv/checks/`). The set of pipelines is that of
//! the picture except for these stages. It is drawn twice: the first draw counts, the second one reads the operands at the first places.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde_json::{Value, json};

use super::compile::asserts::text_of;
use super::library::Stage;
pub use super::spirv::checks::Rule;
use super::spirv::checks::{Check, MASK_WORDS, MOST_DERIVATIVES, MOST_OPERANDS, Names, check};
use super::spirv::trace::with_constants;
use super::trace::{EXTENSIONS, TracedValue, compile_listening};
use super::{Compiler, Diagnostic, ShaderSet, Source, StageKind, TreePath};

/// Words of a check in the buffer: count, first place, operands.
const CHECK: usize = 2 + MOST_OPERANDS;
/// Words of a stage in the buffer.
const PART: usize = CHECK * 32 * MASK_WORDS;
/// Numbers in the text that stand for the address of the stage's part, for the words of bits that are in use, for the address of the
/// marks, for the width and the number of the marked pixels, and for the stage.
const STANDING_FOR: [u32; 8] =
    [0xC0DE_0B01, 0xC0DE_0B02, 0xC0DE_0B03, 0xC0DE_0B04, 0xC0DE_0B05, 0xC0DE_0B06, 0xC0DE_0B07, 0xC0DE_0B08];
/// Marks the pixel of a fragment.
const MARK: &str = "uint pixel = uint(gl_FragCoord.y) * SPECULA_WIDTH + uint(gl_FragCoord.x);
    SpeculaChecks marks = SpeculaChecks(uvec2(SPECULA_MARKS_LOW, SPECULA_MARKS_HIGH));
    if (pixel < SPECULA_PIXELS) marks.words[pixel] = SPECULA_STAGE | check;";
const NAMES: Names<'_> = Names {
    mask: "specula_check_bits",
    function: "specula_check_operands",
    print: "specula_check_print",
    gone: "specula_check_gone",
    quads: "specula_check_quads",
    silent: "specula_check",
};

/// Extensions for the text that asks which invocations of a quad run along.
const BALLOTS: &str =
    "#extension GL_KHR_shader_subgroup_basic : require\n#extension GL_KHR_shader_subgroup_ballot : require";

/// The stages of a frame, compiled with the text that checks them.
pub struct CheckedStages<'a> {
    shaders: &'a ShaderSet,
    source: &'a Source,
    stages: Vec<CheckedStage>,
    buffer: CheckBuffer,
    undefined: bool,
}

/// The checks besides those that the author asserts and prints.
#[derive(Clone, Copy, Debug, Default)]
pub struct Operations {
    /// Operations whose result GLSL leaves open.
    pub undefined: bool,
    /// Derivatives among them: fragment stages can ask which invocations of their quad run along.
    pub derivatives: bool,
}

/// The buffer of a checked picture: a part for each stage, then a mark for each pixel.
#[derive(Clone, Copy, Debug)]
pub struct CheckBuffer {
    /// Its address on the device.
    pub address: u64,
    /// Width and height of the picture.
    pub size: (u32, u32),
}

impl CheckBuffer {
    /// Bytes of the buffer for this many stages.
    pub fn bytes(stages: usize, (width, height): (u32, u32)) -> u64 {
        4 * ((PART * stages.max(1)) as u64 + u64::from(width) * u64::from(height))
    }
}

struct CheckedStage {
    stage: Arc<Stage>,
    /// Whether its image has the size of the picture.
    marks: bool,
    words: Vec<u32>,
    checks: Vec<Check>,
    left_out: usize,
}

/// An operation that broke a rule.
#[derive(Clone, Debug, PartialEq)]
pub struct Broken {
    /// Its stage, an index into the stages of the picture, and the number of its check there.
    pub key: (usize, usize),
    /// The file of the tree.
    pub file: String,
    /// From 1.
    pub line: u32,
    /// The rule.
    pub rule: Rule,
    /// The variable that was read; empty for other rules.
    pub name: String,
    /// The text of an `assert()` or a `print()`.
    pub text: Option<String>,
    /// The stage.
    pub stage: TreePath,
    /// The kind of the stage.
    pub kind: StageKind,
    /// In how many fragments, vertices or invocations.
    pub count: u32,
    /// Where first: a pixel from the upper left corner of the stage's image, an invocation, or x alone for a vertex or primitive.
    pub first: (u32, u32),
    /// The operands there.
    pub operands: Vec<TracedValue>,
}

impl<'a> CheckedStages<'a> {
    /// Compiles these stages of `shaders`, each with whether its image has the size of the picture, so that it is marked.
    ///
    /// # Errors
    /// A message why a stage cannot be checked.
    pub fn new(
        shaders: &'a ShaderSet,
        stages: &BTreeMap<String, bool>,
        (compiler, source): (&Compiler, &'a Source),
        (buffer, operations): (CheckBuffer, Operations),
    ) -> Result<Self, String> {
        let stages = stages.iter().filter_map(|(path, marks)| Some((shaders.stages.get(path)?, *marks)));
        let compiled = stages.map(|(stage, marks)| {
            let quads = operations.undefined && operations.derivatives && stage.kind == StageKind::Fragment;
            let extensions = if quads { format!("{EXTENSIONS}\n{BALLOTS}") } else { EXTENSIONS.to_owned() };
            let text = text(stage.kind, quads);
            let (_, words) = compile_listening(shaders, &stage.path, (compiler, source), (&text, &extensions))?;
            Ok(CheckedStage { stage: stage.clone(), marks, words, checks: Vec::new(), left_out: 0 })
        });
        let stages = compiled.collect::<Result<Vec<_>, String>>()?;
        Ok(Self { shaders, source, stages, buffer, undefined: operations.undefined })
    }

    /// The content of the buffer before the first draw: no check has failed.
    pub fn empty(&self) -> Vec<u32> {
        let check = [&[0, u32::MAX][..], &[0; MOST_OPERANDS]].concat();
        let mut words = check.repeat(32 * MASK_WORDS * self.stages.len());
        words.resize(words.len() + self.pixels() as usize, 0);
        words
    }

    fn pixels(&self) -> u32 {
        self.buffer.size.0 * self.buffer.size.1
    }

    /// The shaders that count.
    ///
    /// # Errors
    /// A message why a stage cannot be checked.
    pub fn counting(&mut self) -> Result<Arc<ShaderSet>, String> {
        self.instrumented(None)
    }

    /// The shaders that read the operands of these checks, where the buffer says that they failed first.
    ///
    /// # Errors
    /// As [`CheckedStages::counting`].
    pub fn reading(&mut self, broken: &[Broken]) -> Result<Arc<ShaderSet>, String> {
        let mut chosen: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
        broken.iter().for_each(|broken| _ = chosen.entry(broken.key.0).or_default().insert(broken.key.1));
        self.instrumented(Some(&chosen))
    }

    fn instrumented(&mut self, chosen: Option<&BTreeMap<usize, BTreeSet<usize>>>) -> Result<Arc<ShaderSet>, String> {
        let mut shaders = self.shaders.clone();
        let (count, pixels) = (self.stages.len(), self.pixels());
        for (index, stage) in self.stages.iter_mut().enumerate() {
            let of_stage = match chosen.map(|chosen| chosen.get(&index)) {
                None => None,
                Some(Some(chosen)) => Some(chosen),
                // Nothing failed in this stage.
                Some(None) => continue,
            };
            let path = &stage.stage.path;
            let lacks = || format!("{path} cannot be checked");
            let checked = check(&stage.words, &NAMES, self.undefined, of_stage).ok_or_else(lacks)?;
            let part = self.buffer.address + 4 * (PART * index) as u64;
            let marks = self.buffer.address + 4 * (PART * count) as u64;
            let used = if chosen.is_some() { 0 } else { checked.checks.len().div_ceil(32) as u32 };
            let pixels = if stage.marks { pixels } else { 0 };
            let [low, high] = [part as u32, (part >> 32) as u32];
            let [marks_low, marks_high] = [marks as u32, (marks >> 32) as u32];
            let number = (index as u32 + 1) << 16;
            let values = [low, high, used, marks_low, marks_high, self.buffer.size.0, pixels, number];
            let changes: Vec<(u32, u32)> = STANDING_FOR.into_iter().zip(values).collect();
            let words = with_constants(&checked.words, &changes).ok_or_else(lacks)?;
            (stage.checks, stage.left_out) = (checked.checks, checked.left_out);
            shaders.stages.insert(path.to_string(), Arc::new(stage.stage.with_module(words)));
        }
        Ok(Arc::new(shaders))
    }

    /// How many operations are not checked, since a stage has more than there are bits.
    pub fn left_out(&self) -> usize {
        self.stages.iter().map(|stage| stage.left_out).sum()
    }

    /// How many operations are checked.
    pub fn check_count(&self) -> usize {
        self.stages.iter().map(|stage| stage.checks.len()).sum()
    }

    /// The operations that broke a rule, by the words of the buffer, in the order of files and lines.
    pub fn broken(&self, words: &[u32]) -> Vec<Broken> {
        let parts = self.stages.iter().enumerate().zip(words.chunks_exact(PART));
        let mut found: Vec<Broken> = parts
            .flat_map(|((index, stage), part)| {
                let failed = stage.checks.iter().enumerate().zip(part.chunks_exact(CHECK));
                failed.filter(|(_, words)| words[0] > 0).map(move |((number, check), words)| {
                    let mut left = &words[2..];
                    let operands = check.operands.iter().map(|(kind, count)| {
                        let (bits, rest) = left.split_at((*count as usize).min(left.len()));
                        left = rest;
                        TracedValue::new(*kind, bits)
                    });
                    Broken {
                        key: (index, number),
                        file: check.file.clone(),
                        line: check.line,
                        rule: check.rule,
                        name: check.name.clone(),
                        text: check.text.and_then(|number| self.text(&check.file, number)),
                        stage: stage.stage.path.clone(),
                        kind: stage.stage.kind,
                        count: words[0],
                        first: place(stage.stage.kind, words[1]),
                        operands: operands.collect(),
                    }
                })
            })
            .collect();
        found.sort_by(|a, b| (&a.file, a.line, a.rule, &a.stage).cmp(&(&b.file, b.line, b.rule, &b.stage)));
        found
    }

    /// For each pixel, from the upper left corner, the place in `broken` of a check that failed there, from 1, or 0.
    pub fn marks(&self, words: &[u32], broken: &[Broken]) -> Vec<u16> {
        let place = |word: &u32| {
            let key = ((*word >> 16) as usize).checked_sub(1).zip(((*word & 0xffff) as usize).checked_sub(1));
            let at = key.and_then(|key| broken.iter().position(|broken| broken.key == key));
            at.and_then(|at| u16::try_from(at + 1).ok()).unwrap_or(0)
        };
        words.get(PART * self.stages.len()..).unwrap_or_default().iter().map(place).collect()
    }

    fn text(&self, file: &str, number: u32) -> Option<String> {
        text_of(self.shaders.texts.get(&TreePath::from(file))?, number)
    }

    /// Tells of a broken rule, with the line of its file: an error, or a warning of what is printed.
    pub fn diagnostic(&self, broken: &Broken) -> Diagnostic {
        let path = TreePath::from(broken.file.as_str());
        let text = self.shaders.author_text(&path);
        let line = text.and_then(|text| text.lines().nth((broken.line as usize).checked_sub(1)?));
        let (file, message) = (self.source.display_path(&path), broken.message());
        let told =
            if broken.is_fault() { Diagnostic::error(file, message) } else { Diagnostic::warning(file, message) };
        told.on_line(broken.line, line)
    }
}

impl Broken {
    /// Whether it is a fault, and not only a value that is printed.
    pub fn is_fault(&self) -> bool {
        self.rule != Rule::Print
    }

    /// It for programs. `diagnostic`: the same for a reader.
    pub fn json(&self, diagnostic: &Diagnostic) -> Value {
        let operands: Vec<Value> = self.operands.iter().map(TracedValue::json).collect();
        json!({ "file": self.file, "path": diagnostic.file, "line": self.line, "rule": self.rule.name(), "name": self.name, "text": self.text,
            "message": self.message(), "stage": self.stage.as_str(), "count": self.count,
            "first": [self.first.0, self.first.1], "operands": operands })
    }

    /// The fault in one sentence, with operands, how often, and where first.
    pub fn message(&self) -> String {
        let operands: Vec<String> = self.operands.iter().map(TracedValue::text).collect();
        let (x, y) = self.first;
        let (unit, first) = match self.kind {
            StageKind::Fragment => ("fragment", format!("at the pixel {x},{y}")),
            // Larger numbers have no room.
            StageKind::Compute if x == 0xffff => ("invocation", format!("of the invocation {x},{y} or a later one")),
            StageKind::Compute => ("invocation", format!("of the invocation {x},{y}")),
            StageKind::Vertex => ("invocation", format!("of the vertex {x}")),
            _ => ("invocation", format!("of the primitive {x}")),
        };
        let count = crate::message::grouped(f64::from(self.count));
        let plural = if self.count == 1 { "" } else { "s" };
        let where_ = format!("first {first}, in {count} {unit}{plural} of {}", self.stage);
        let text = self.text.as_deref().unwrap_or_default();
        match (self.rule, operands.join(" and ")) {
            (Rule::Print, values) => format!("{text} = {values} {where_}"),
            (rule @ Rule::Assert, values) => {
                let parts = [text, &values].into_iter().filter(|part| !part.is_empty());
                let parts: String = parts.map(|part| format!(": {part}")).collect();
                format!("{rule}{parts}, {where_}")
            }
            (rule @ Rule::Unset, _) => format!("{rule}: {} {where_}", self.name),
            (rule, values) if values.is_empty() => format!("{rule}, {where_}"),
            (rule, values) => format!("{rule}: {values} {where_}"),
        }
    }
}

/// A place as the text packs it.
fn place(kind: StageKind, packed: u32) -> (u32, u32) {
    match kind {
        StageKind::Fragment | StageKind::Compute => (packed & 0xffff, packed >> 16),
        _ => (packed, 0),
    }
}

/// The text that is appended to a stage of this kind. `quads`: it asks which invocations of a quad run along.
fn text(kind: StageKind, quads: bool) -> String {
    let (place, counts) = match kind {
        // The pixels around a triangle run along for derivatives.
        StageKind::Fragment => ("(uint(gl_FragCoord.y) << 16 | uint(gl_FragCoord.x))", "!gl_HelperInvocation"),
        StageKind::Compute => ("(gl_GlobalInvocationID.y << 16 | min(gl_GlobalInvocationID.x, 0xffffu))", "true"),
        StageKind::Vertex => ("uint(gl_VertexIndex)", "true"),
        StageKind::TessellationControl | StageKind::TessellationEvaluation => ("uint(gl_PrimitiveID)", "true"),
        StageKind::Geometry => ("uint(gl_PrimitiveIDIn)", "true"),
        StageKind::Task | StageKind::Mesh => ("gl_WorkGroupID.x", "true"),
    };
    let number = |number: u32| format!("{number}u");
    let mark = if kind == StageKind::Fragment { MARK } else { "" };
    let [declared, begin, end] = match quads {
        true => [
            include_str!("quads.glsl"),
            "specula_check_begun = subgroupBallot(true);\n    if (specula_check_gone() != 0u) specula_check_quads[0] = 0u;",
            "specula_check_quads_end();",
        ],
        false => [""; 3],
    };
    include_str!("checks.glsl")
        .replace("SPECULA_QUADS_BEGIN", begin)
        .replace("SPECULA_QUADS_END", end)
        .replace("SPECULA_QUADS", declared)
        .replace("SPECULA_DERIVATIVES", &number(MOST_DERIVATIVES as u32))
        .replace("SPECULA_MARK;", mark)
        .replace("SPECULA_MARKS_LOW", &number(STANDING_FOR[3]))
        .replace("SPECULA_MARKS_HIGH", &number(STANDING_FOR[4]))
        .replace("SPECULA_WIDTH", &number(STANDING_FOR[5]))
        .replace("SPECULA_PIXELS", &number(STANDING_FOR[6]))
        .replace("SPECULA_STAGE", &number(STANDING_FOR[7]))
        .replace("SPECULA_PLACE", place)
        .replace("SPECULA_COUNTS", counts)
        .replace("SPECULA_LOW", &number(STANDING_FOR[0]))
        .replace("SPECULA_HIGH", &number(STANDING_FOR[1]))
        .replace("SPECULA_USED", &number(STANDING_FOR[2]))
        .replace("SPECULA_WORDS", &number(MASK_WORDS as u32))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::source::snapshot::Snapshot;
    use crate::shader::spirv::{optimize, validate};

    #[test]
    fn checked_stages_of_the_tree_are_valid() {
        let (source, compiler) = (Source::embedded(), Compiler::new().unwrap());
        let snapshot = Snapshot::new(&source);
        let texts = source.list().into_iter().filter_map(|path| Some((path.clone(), snapshot.read(&path).ok()?)));
        let shaders = ShaderSet { texts: texts.collect(), ..ShaderSet::default() };
        for path in ["pbr.frag", "debug.frag", "pbr.vert", "tonemap.frag", "deform.comp"] {
            let path = TreePath::from(path);
            let kind = StageKind::of(&path).unwrap();
            let quads = kind == StageKind::Fragment;
            let extensions = if quads { format!("{EXTENSIONS}\n{BALLOTS}") } else { EXTENSIONS.to_owned() };
            let text = (text(kind, quads), extensions);
            let (_, words) = compile_listening(&shaders, &path, (&compiler, &source), (&text.0, &text.1)).unwrap();
            let counting = check(&words, &NAMES, true, None).unwrap();
            let all: BTreeSet<usize> = (0..counting.checks.len()).collect();
            let reading = check(&words, &NAMES, true, Some(&all)).unwrap();
            assert_eq!(counting.checks, reading.checks, "{path}");
            assert!(!all.is_empty() && all.len() < 32 * MASK_WORDS, "{path}: {} checks", all.len());
            for words in [&counting.words, &reading.words] {
                assert_eq!(validate(words), Ok(()), "{path}");
                assert_eq!(validate(&optimize(words.clone())), Ok(()), "{path}, optimized");
            }
            let has_derivatives = counting.checks.iter().any(|check| check.rule == Rule::Derivative);
            assert_eq!(has_derivatives, quads, "{path}");
            let without = check(&words, &NAMES, false, None).unwrap();
            assert!(without.checks.is_empty(), "{path}: {:?}", without.checks);
        }
    }
}
