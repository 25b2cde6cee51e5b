//! A stage without one of its functions at a time, to measure what they cost.
//!
//! The stage is compiled again with a text that records what functions return (`costs.glsl`), and with one that reads it (`read.glsl`). The second module is drawn as it is and without each of its functions in turn. Both are the author's code besides
//! these texts, and the set of pipelines is that of the picture except for this stage.

mod batch;

use std::collections::HashMap;
use std::ops::RangeInclusive;
use std::sync::Arc;

use super::glsl::Code;
use super::glsl::syntax::{Function, functions as functions_of_text};
use super::library::Stage;
pub use super::spirv::cost::Lack;
use super::spirv::cost::{Known, Names, StageFunction, functions, groups, without};
use super::spirv::trace::with_constants;
use super::trace::{EXTENSIONS, compile_listening};
use super::{Compiler, ShaderSet, Source, TreePath, specialize};
pub use batch::{Batch, Recorded};

/// Numbers in the text that stand for the address of the results.
const STANDING_FOR: [u32; 2] = [0xC0DE_0C01, 0xC0DE_0C02];
const NAMES: Names<'_> = Names {
    main: "specula_main",
    own: "specula_cost",
    read: "specula_cost_read",
    count: "specula_cost_count_",
    values: "specula_cost_values_",
};

/// A stage whose functions can be left out.
pub struct CostStage<'a> {
    shaders: &'a Arc<ShaderSet>,
    stage: Arc<Stage>,
    tools: (&'a Compiler, &'a Source),
    words: Vec<u32>,
    functions: Vec<StageFunction>,
    known: Known,
}

/// A function of a stage, for a reader.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedFunction {
    /// Its name with the types of its parameters.
    pub signature: String,
    /// The file of the tree; empty if it is not known.
    pub file: String,
    /// The line where it begins, from 1.
    pub line: u32,
}

/// How often a function is called.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Calls {
    /// By all invocations of the stage.
    pub calls: u32,
    /// How many invocations call it.
    pub invocations: u32,
}

impl<'a> CostStage<'a> {
    /// Compiles the stage at `path` of `shaders`. `constants`: the lists of constants with which the picture has it.
    ///
    /// # Errors
    /// A message why its functions cannot be left out.
    pub fn new(
        shaders: &'a Arc<ShaderSet>,
        path: &str,
        tools: (&'a Compiler, &'a Source),
        constants: &[&[(u32, u32)]],
    ) -> Result<Self, String> {
        let stage = shaders.stages.get(path).ok_or_else(|| format!("{path} is no stage that has compiled"))?;
        let text = with_address(include_str!("read.glsl"), STANDING_FOR);
        let (_, words) = compile_listening(shaders, &stage.path, tools, (&text, EXTENSIONS))?;
        let lacks = || format!("the functions of {path} cannot be measured");
        let mut functions = functions(&words, &NAMES).ok_or_else(lacks)?;
        let plain = without(&words, None, &NAMES).ok_or_else(lacks)?;
        let mut known = Known::default();
        constants.iter().for_each(|constants| known.add(&specialize(&plain, constants)));
        functions.iter_mut().for_each(|function| function.lack = known.lack(function));
        Ok(Self { shaders, stage: stage.clone(), tools, words, functions, known })
    }

    /// The functions, callees before their callers, each with why it cannot be left out.
    pub fn functions(&self) -> Vec<(NamedFunction, Option<Lack>)> {
        let mut headers: HashMap<&str, Vec<RangeInclusive<u32>>> = HashMap::new();
        let named = self.functions.iter().map(|function| {
            let of_file = headers.entry(function.file.as_str()).or_insert_with(|| self.headers(&function.file));
            let around = of_file.iter().find(|lines| lines.contains(&function.line));
            let line = around.map_or(function.line, |lines| *lines.start());
            let named = NamedFunction { signature: function.signature.clone(), file: function.file.clone(), line };
            (named, function.lack.clone())
        });
        named.collect()
    }

    /// The lines of the functions of a file, from their headers to their ends.
    fn headers(&self, file: &str) -> Vec<RangeInclusive<u32>> {
        let Some(text) = self.shaders.texts.get(&TreePath::from(file)) else { return Vec::new() };
        let code = Code::new(text);
        let lines = |of: &Function| code.number_at(of.head.start)..=code.number_at(of.body.bytes.end);
        functions_of_text(&code.tokens).iter().map(lines).collect()
    }

    /// Words by which the stage without a function may be larger than with it. If it grows by more, constants had decided the result.
    pub fn allowance(&self, function: usize) -> usize {
        self.functions.get(function).map_or(0, |function| self.known.allowance(function))
    }

    /// The content of a buffer with what functions, by their places, have returned.
    pub fn results(&self, recorded: &[(usize, Vec<u32>)]) -> Vec<u32> {
        let (first, count) = groups(&self.functions);
        let mut words = vec![0; 4 * count.max(1) as usize];
        for (at, numbers) in recorded {
            let start = 4 * first.get(*at).copied().unwrap_or(0) as usize;
            words.iter_mut().skip(start).zip(numbers).for_each(|(word, number)| *word = *number);
        }
        words
    }

    /// The shaders without a function, whose results are in the buffer at this address; with `None`, with all of them.
    ///
    /// # Errors
    /// A message why the function cannot be left out.
    pub fn without(&self, function: Option<usize>, address: u64) -> Result<Arc<ShaderSet>, String> {
        let lacks = || format!("the functions of {} cannot be measured", self.stage.path);
        let (first, _) = groups(&self.functions);
        let function = function.and_then(|at| Some((self.functions.get(at)?, *first.get(at)?)));
        let words = without(&self.words, function, &NAMES).ok_or_else(lacks)?;
        let changes = [(STANDING_FOR[0], address as u32), (STANDING_FOR[1], (address >> 32) as u32)];
        Ok(self.with_module(with_constants(&words, &changes).ok_or_else(lacks)?))
    }

    fn with_module(&self, words: Vec<u32>) -> Arc<ShaderSet> {
        let mut shaders = ShaderSet::clone(self.shaders);
        shaders.stages.insert(self.stage.path.to_string(), Arc::new(self.stage.with_module(words)));
        Arc::new(shaders)
    }
}

fn with_address(text: &str, [low, high]: [u32; 2]) -> String {
    text.replace("SPECULA_LOW", &format!("{low}u")).replace("SPECULA_HIGH", &format!("{high}u"))
}

#[cfg(test)]
mod tests {
    use super::super::source::snapshot::Snapshot;
    use super::super::spirv::{optimize, validate};
    use super::*;

    /// The shipped tree, of which the texts are enough.
    fn shaders(source: &Source, compiler: &Compiler, paths: &[&str]) -> Arc<ShaderSet> {
        let snapshot = Snapshot::new(source);
        let texts = source.list().into_iter().filter_map(|path| Some((path.clone(), snapshot.read(&path).ok()?)));
        let mut shaders = ShaderSet { texts: texts.collect(), ..ShaderSet::default() };
        for path in paths {
            let compiled = compiler.compile(&snapshot, &TreePath::from(*path));
            let stage = Stage::of_module(&TreePath::from(*path), compiled.result.unwrap(), compiled.dependencies);
            shaders.stages.insert((*path).to_owned(), Arc::new(stage));
        }
        Arc::new(shaders)
    }

    #[test]
    fn stages_of_the_tree_are_valid_without_each_function() {
        let (source, compiler) = (Source::embedded(), Compiler::new().unwrap());
        let paths = ["pbr.frag", "tonemap.frag", "deform.comp"];
        let all = shaders(&source, &compiler, &paths);
        for path in paths {
            let stage = CostStage::new(&all, path, (&compiler, &source), &[&[]]).unwrap();
            let functions = stage.functions();
            let measured: Vec<usize> = (0..functions.len()).filter(|at| functions[*at].1.is_none()).collect();
            let valid = |shaders: &ShaderSet, what: &str| {
                let words = &shaders.stages[path].spirv;
                assert_eq!(validate(words), Ok(()), "{path}: {what}");
                assert_eq!(validate(&optimize(specialize(words, &[]))), Ok(()), "{path}: {what}, optimized");
            };
            let batches = Batch::all(&stage, &measured);
            assert_eq!(batches.len(), measured.len().div_ceil(8));
            batches
                .iter()
                .take(2)
                .for_each(|batch| valid(&batch.shaders(0x1_0000_1000, (640, 480)).unwrap(), "recording"));
            valid(&stage.without(None, 0x1_0000_1000).unwrap(), "whole");
            // All of them take long.
            for at in measured.iter().step_by(measured.len().div_ceil(12).max(1)) {
                valid(&stage.without(Some(*at), 0x1_0000_1000).unwrap(), &functions[*at].0.signature);
            }
            if path == "pbr.frag" {
                let named = |name: &str| functions.iter().find(|(of, _)| of.signature.starts_with(name)).unwrap();
                let (of, lack) = named("d_ggx(").clone();
                assert_eq!((of.file.as_str(), lack), ("brdf/ndf.glsl", None));
                assert!(measured.len() > 20, "{functions:?}");
            }
        }
    }
}
