//! One stage of a library: how it is built, and what is remembered about it between updates.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::Instant;

use crate::interface::SET_PASS;
use crate::shader::compile::{Compiler, StageKind, module_cache};
use crate::shader::contract::{self, Texts};
use crate::shader::diagnostic::Diagnostic;
use crate::shader::incremental::{FileCache, Files, Rebuilt, rebuild};
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::hooks::Hooks;
use crate::shader::spirv::reach::{Used, reached};
use crate::shader::spirv::reflect::Reflection;
use crate::shader::spirv::{Module, behavior_hash, can_index_draws, optimize, specialize};

/// A compiled stage.
#[derive(Debug)]
pub struct Stage {
    /// The file with its `main()`.
    pub path: TreePath,
    /// The kind of stage.
    pub kind: StageKind,
    /// The unoptimized module.
    pub spirv: Vec<u32>,
    /// Its declarations.
    pub reflection: Reflection,
    /// Effects of the author's hooks in it.
    pub hooks: Hooks,
    /// The stage's files, and the paths where an include was not found.
    pub dependencies: BTreeSet<TreePath>,
    /// The specialized modules that were asked for, the newest first.
    specialized: Mutex<Vec<Specialized>>,
    /// See [`Stage::live_pass_bindings`].
    live: OnceLock<BTreeSet<u32>>,
    /// See [`Stage::can_index_draws`].
    indexes_draws: OnceLock<bool>,
}

/// A stage's module with values for its constants.
#[derive(Debug)]
struct Specialized {
    constants: Constants,
    hash: u64,
    /// The module, until a pipeline takes it.
    words: Option<Vec<u32>>,
}

/// Hashes that a stage keeps.
const HASHES_KEPT: usize = 64;
/// Modules that a stage keeps until pipelines take them: as many as a scene has kinds of material, of 100 kB each.
const MODULES_KEPT: usize = 8;

/// Values of specialization constants: `constant_id` and the four bytes.
type Constants = Vec<(u32, u32)>;

impl PartialEq for Stage {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path && self.spirv == other.spirv && self.dependencies == other.dependencies
    }
}

impl Stage {
    /// [`Stage::specialized_hash`], if it has been computed.
    pub fn known_hash(&self, constants: &[(u32, u32)]) -> Option<u64> {
        self.specialized().iter().find(|known| known.constants == constants).map(|known| known.hash)
    }

    /// [`behavior_hash`] of the module that the driver gets for these constants. Computed once.
    pub fn specialized_hash(&self, constants: &[(u32, u32)]) -> u64 {
        if let Some(known) = self.known_hash(constants) {
            return known;
        }
        // Computed without the lock, since the pipelines of a scene are built in parallel.
        let words = specialize(&self.spirv, constants);
        let hash = behavior_hash(&words);
        let mut all = self.specialized();
        // A constant's slider requests one module per value.
        all.truncate(HASHES_KEPT - 1);
        all.insert(0, Specialized { constants: constants.to_vec(), hash, words: Some(words) });
        all.iter_mut().skip(MODULES_KEPT).for_each(|old| old.words = None);
        hash
    }

    /// The module with these constants, as [`specialize`] gives it.
    pub fn specialize(&self, constants: &[(u32, u32)]) -> Vec<u32> {
        let mut all = self.specialized();
        let known = all.iter_mut().find(|known| known.constants == constants);
        let words = known.and_then(|known| known.words.take());
        drop(all);
        words.unwrap_or_else(|| specialize(&self.spirv, constants))
    }

    /// The bindings of `interface::SET_PASS` that the outputs of the stage depend on, whatever its constants are. Computed once, since it
    /// takes the optimizer.
    pub fn live_pass_bindings(&self) -> &BTreeSet<u32> {
        self.live.get_or_init(|| {
            let module = Module::parse(&optimize(self.spirv.clone()));
            module.map(|module| Used::bindings(&reached(&module), SET_PASS)).unwrap_or_default()
        })
    }

    /// Whether the stage can find its draw in a buffer: [`can_index_draws`]. Computed once.
    pub fn can_index_draws(&self) -> bool {
        *self.indexes_draws.get_or_init(|| can_index_draws(&self.spirv))
    }

    fn specialized(&self) -> MutexGuard<'_, Vec<Specialized>> {
        self.specialized.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The stage with another module that declares the same.
    pub fn with_module(&self, spirv: Vec<u32>) -> Self {
        Self::new(&self.path, self.kind, (spirv, self.reflection.clone()), self.dependencies.clone())
    }

    /// A stage of which only the module is known.
    #[cfg(test)]
    pub(in crate::shader) fn of_module(path: &TreePath, spirv: Vec<u32>, dependencies: BTreeSet<TreePath>) -> Self {
        let kind = StageKind::of(path).expect("the path of a stage");
        Self::new(path, kind, (spirv, Reflection::default()), dependencies)
    }

    fn new(
        path: &TreePath,
        kind: StageKind,
        (spirv, reflection): (Vec<u32>, Reflection),
        dependencies: BTreeSet<TreePath>,
    ) -> Self {
        Self {
            path: path.clone(),
            kind,
            reflection,
            hooks: Hooks::of(&spirv),
            spirv,
            dependencies,
            specialized: Mutex::default(),
            live: OnceLock::new(),
            indexes_draws: OnceLock::new(),
        }
    }

    /// The stage's source text, for messages.
    pub(super) fn texts<'a>(&'a self, snapshot: &'a Snapshot<'a>) -> Texts<'a> {
        Texts { snapshot, stage: &self.path, dependencies: &self.dependencies }
    }
}

/// A successful compilation.
#[derive(Clone)]
pub(super) struct Built {
    pub stage: Arc<Stage>,
    /// Hash of the text that was compiled.
    pub hash: u64,
    pub warnings: Vec<Diagnostic>,
    /// The text, if all of it could be read.
    pub files: Option<Files>,
}

/// A failed compilation.
#[derive(Clone)]
pub(super) struct Broken {
    /// Hash of the text that was compiled.
    pub hash: u64,
    pub dependencies: BTreeSet<TreePath>,
    pub diagnostics: Vec<Diagnostic>,
}

/// The result of compiling, reflecting and checking a stage.
pub(super) type Outcome = Result<Built, Broken>;

/// The state of one stage between updates.
pub(super) struct StageSlot {
    pub path: TreePath,
    /// The result for the latest text.
    pub current: Option<Outcome>,
    /// The result in the last good set.
    pub good: Option<Built>,
}

impl StageSlot {
    /// A stage that was not compiled yet.
    pub fn new(path: TreePath) -> Self {
        Self { path, current: None, good: None }
    }

    /// Whether the latest text has compiled.
    pub fn is_good(&self) -> bool {
        matches!(self.current, Some(Ok(_)))
    }

    /// Whether the latest text has compiled to another stage than that of the last good set.
    pub fn is_new(&self) -> bool {
        let Some(Ok(built)) = &self.current else { return false };
        self.good.as_ref().is_none_or(|good| !Arc::ptr_eq(&good.stage, &built.stage))
    }

    /// Whether the current result, if there is one, is that of the snapshot's text.
    pub fn is_current(&self, snapshot: &Snapshot<'_>) -> bool {
        self.current.as_ref().is_none_or(|outcome| snapshot.closure_hash(dependencies_of(outcome)) == hash_of(outcome))
    }

    /// The start of the next compilation. If `is_whole`, it takes nothing from an earlier one.
    pub fn start(&self, is_whole: bool) -> Start<'_> {
        match self.base() {
            _ if self.current.is_none() && self.good.is_none() => Start::Disk,
            Some(base) if !is_whole => Start::Base(base),
            _ => Start::Text,
        }
    }

    /// The newest result that an edit can be compiled against.
    fn base(&self) -> Option<&Built> {
        let current = self.current.as_ref().and_then(|outcome| outcome.as_ref().ok());
        // A compilation of the changed functions would not repeat the warnings of the others.
        current.or(self.good.as_ref()).filter(|built| built.warnings.is_empty())
    }

    /// Every path whose change can affect the result.
    pub fn dependencies(&self) -> impl Iterator<Item = &TreePath> {
        let current = self.current.as_ref().map(dependencies_of);
        let good = self.good.as_ref().map(|built| &built.stage.dependencies);
        std::iter::once(&self.path).chain([current, good].into_iter().flatten().flatten())
    }

    /// Restores the result that is known for exactly the snapshot's text. Returns `None` if there is none, else whether
    /// it differs from the current one.
    pub fn recall(&mut self, snapshot: &Snapshot<'_>) -> Option<bool> {
        let good = self.good.clone().map(Ok);
        let known = [self.current.clone(), good]
            .into_iter()
            .flatten()
            .find(|outcome| snapshot.closure_hash(dependencies_of(outcome)) == hash_of(outcome))?;
        let moved = !self.current.as_ref().is_some_and(|current| same(current, &known));
        self.current = Some(known);
        Some(moved)
    }

    /// Stores a new result. If the module is unchanged (an edit of a comment, or the same text compiled again), the
    /// stage remains the same object, and no pipeline is rebuilt. A module that was compiled as a whole, with
    /// `is_whole`, is also unchanged if it does the same as one that was linked.
    pub fn accept(&mut self, outcome: Outcome, is_whole: bool) {
        let does_same = |a: &Stage, b: &Stage| {
            (&a.reflection, &a.dependencies) == (&b.reflection, &b.dependencies)
                && behavior_hash(&a.spirv) == behavior_hash(&b.spirv)
        };
        self.current = Some(match (outcome, &self.good) {
            (Ok(built), Some(good))
                if built.stage == good.stage || (is_whole && does_same(&built.stage, &good.stage)) =>
            {
                Ok(Built { stage: Arc::clone(&good.stage), ..built })
            }
            (outcome, _) => outcome,
        });
    }
}

fn dependencies_of(outcome: &Outcome) -> &BTreeSet<TreePath> {
    match outcome {
        Ok(built) => &built.stage.dependencies,
        Err(broken) => &broken.dependencies,
    }
}

fn hash_of(outcome: &Outcome) -> u64 {
    outcome.as_ref().map_or_else(|broken| broken.hash, |built| built.hash)
}

fn same(a: &Outcome, b: &Outcome) -> bool {
    match (a, b) {
        (Ok(a), Ok(b)) => a.hash == b.hash,
        (Err(a), Err(b)) => a.hash == b.hash,
        _ => false,
    }
}

/// A stage that was built.
pub(super) struct Done {
    pub outcome: Outcome,
    /// Wall time of the compilation in milliseconds; `None` if the stage's code has not changed.
    pub ms: Option<f64>,
}

/// An earlier result that the compilation of a stage can start from.
#[derive(Clone, Copy)]
pub(super) enum Start<'a> {
    /// The text alone.
    Text,
    /// The module that an earlier process compiled of the same text, if it is on disk.
    Disk,
    /// An earlier result. If the text differs from its text only in functions, only these are compiled.
    Base(&'a Built),
}

/// Compiles, reflects and checks one stage.
pub(super) fn build(
    compiler: &Compiler,
    snapshot: &Snapshot<'_>,
    cache: &FileCache,
    path: &TreePath,
    from: Start<'_>,
) -> Done {
    let start = Instant::now();
    let base = match from {
        // The linker does not know what the capabilities of a mesh pipeline depend on.
        Start::Base(base) if !base.stage.kind.is_of_mesh_pipeline() => Some(base),
        _ => None,
    };
    let files = base.and_then(|base| cache.files(snapshot, &base.stage.dependencies));
    let rebuilt = base.zip(files.as_ref()).and_then(|(base, files)| {
        let old = (base.stage.spirv.as_slice(), base.files.as_ref()?);
        Some((base, rebuild(compiler, snapshot, path, old, files)?))
    });
    let (spirv, dependencies, warnings) = match rebuilt {
        Some((base, Rebuilt::Same)) => {
            let (stage, hash) = (Arc::clone(&base.stage), snapshot.closure_hash(&base.stage.dependencies));
            return Done { outcome: Ok(Built { stage, hash, warnings: Vec::new(), files }), ms: None };
        }
        Some((base, Rebuilt::Linked(spirv))) => (Ok(spirv), base.stage.dependencies.clone(), Vec::new()),
        None => {
            let is_start = matches!(from, Start::Disk);
            let compiled = is_start.then(|| module_cache::load(snapshot, path)).flatten().unwrap_or_else(|| {
                let compiled = compiler.compile(snapshot, path);
                if is_start {
                    module_cache::store(snapshot, path, &compiled);
                }
                compiled
            });
            (compiled.result, compiled.dependencies, compiled.warnings)
        }
    };
    let ms = Some(start.elapsed().as_secs_f64() * 1e3);
    let hash = snapshot.closure_hash(&dependencies);
    let broken = |diagnostics| Err(Broken { hash, dependencies: dependencies.clone(), diagnostics });
    let spirv = match spirv {
        Ok(spirv) => spirv,
        Err(errors) => return Done { outcome: broken(errors.into_iter().chain(warnings).collect()), ms },
    };
    let reflection = Reflection::of(&spirv);
    let errors = contract::check(&reflection, Texts { snapshot, stage: path, dependencies: &dependencies });
    let outcome = match StageKind::of(path) {
        Some(kind) if errors.is_empty() => {
            let files = cache.files(snapshot, &dependencies);
            let stage = Arc::new(Stage::new(path, kind, (spirv, reflection), dependencies));
            Ok(Built { stage, hash, warnings, files })
        }
        _ => broken(errors),
    };
    Done { outcome, ms }
}
