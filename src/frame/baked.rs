//! The keys of what is baked from shaders: the BRDF's tables and an environment's images.

use std::ops::Range;
use std::sync::Arc;

use crate::frame::stages::{PREFILTER_STAGES, RADIANCE_STAGES, SHEEN_STAGES, TABLE_STAGES};
use crate::gpu::Specialization;
use crate::scene::environment::{MODEL, ModelEnvironment};
use crate::shader::{ShaderSet, Stage};

/// A compute stage with the author's constants that it declares, and the author's parameters. Two are equal if the driver is
/// known to get the same module, and the parameters that it reads have the same values. So constants without effect on the
/// module, and edits of comments, make no difference once the thread that bakes has hashed both modules.
#[derive(Clone, Debug)]
pub struct BakeStage {
    pub(crate) stage: Arc<Stage>,
    pub(crate) constants: Specialization,
    /// The bytes of the block `Params`.
    pub(crate) params: Arc<[u8]>,
}

impl BakeStage {
    /// Hash of the specialized module. The first call takes milliseconds, so it is not for the window's thread.
    pub(crate) fn module(&self) -> u64 {
        self.stage.specialized_hash(&self.constants)
    }

    /// Whether both are known to have the same specialized module. Computes no hash.
    fn has_module_of(&self, other: &Self) -> bool {
        let hash = |of: &Self| of.stage.known_hash(&of.constants);
        (Arc::ptr_eq(&self.stage, &other.stage) && self.constants == other.constants)
            || hash(self).is_some_and(|own| hash(other) == Some(own))
    }

    /// The bytes of the parameters that the stage reads.
    pub(crate) fn params_read(&self) -> impl Iterator<Item = &[u8]> {
        let of = |range: &Range<usize>| self.params.get(range.start..range.end.min(self.params.len()));
        self.stage.reflection.params_read.iter().filter_map(of)
    }

    /// Whether the stage reads parameters. Its results are then not cached on disk, which every step of a slider would fill.
    pub(crate) fn reads_params(&self) -> bool {
        !self.stage.reflection.params_read.is_empty()
    }
}

impl PartialEq for BakeStage {
    fn eq(&self, other: &Self) -> bool {
        self.has_module_of(other) && self.params_read().eq(other.params_read())
    }
}

impl Eq for BakeStage {}

/// The author's values that a bake depends on.
#[derive(Clone, Copy, Debug)]
pub struct BakeValues<'a> {
    /// The specialization constants.
    pub constants: &'a Specialization,
    /// The bytes of the block `Params`.
    pub params: &'a Arc<[u8]>,
}

/// The stages of `paths` with the constants that each declares. A tree without one of them has already failed its check.
fn stages(shaders: &ShaderSet, paths: &[&str], values: BakeValues<'_>) -> Vec<BakeStage> {
    let BakeValues { constants, params } = values;
    let stages = paths.iter().filter_map(|path| shaders.stages.get(*path));
    let bake = stages.map(|stage| {
        let declares = |id: u32| stage.reflection.constants.iter().any(|constant| constant.id == id);
        let constants: Specialization = constants.iter().filter(|(id, _)| declares(*id)).copied().collect();
        BakeStage { stage: stage.clone(), constants, params: params.clone() }
    });
    bake.collect()
}

/// Identifies the BRDF lookup tables: a stage for each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TablesKey(pub(crate) Vec<BakeStage>);

impl TablesKey {
    pub(crate) fn new(shaders: &ShaderSet, values: BakeValues<'_>) -> Self {
        Self(stages(shaders, &TABLE_STAGES, values))
    }

    /// Computes the hashes of the modules, by which keys of other shaders or constants can be equal. Takes milliseconds.
    pub(crate) fn resolve(&self) {
        resolve(&self.0);
    }

    /// Whether both differ at most by values of parameters, as two steps of a slider do.
    pub(crate) fn is_step_of(&self, other: &Self) -> bool {
        same_modules(&self.0, &other.0)
    }

    /// Whether both use the same choice of models, so that the tables differ by an edit of the shaders at most.
    pub(crate) fn is_edit_of(&self, other: &Self) -> bool {
        same_constants(&self.0, &other.0)
    }
}

/// Identifies a baked environment: its name, the revision of its file, whether suns are separated, and the stages of each part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EnvironmentKey {
    /// Built-in name or file.
    pub name: String,
    /// The environment of the model's file, if `name` asks for it.
    pub(crate) of_model: Option<Arc<ModelEnvironment>>,
    pub(crate) revision: u64,
    /// Whether suns are separated from the maps.
    pub(crate) suns: bool,
    /// The stages of the cube map and the irradiance, which depend on the map alone.
    pub(crate) radiance: Vec<BakeStage>,
    /// The stages of the prefilter, which also depend on the selected NDF.
    pub(crate) prefilter: Vec<BakeStage>,
    /// The stage of the sheen's prefilter.
    pub(crate) sheen: Vec<BakeStage>,
}

impl EnvironmentKey {
    /// `of_model`: the environment of the model's file.
    pub(crate) fn new(
        (name, revision, suns): (&str, u64, bool),
        of_model: Option<&Arc<ModelEnvironment>>,
        shaders: &ShaderSet,
        values: BakeValues<'_>,
    ) -> Self {
        Self {
            name: name.to_owned(),
            of_model: of_model.filter(|_| name == MODEL).cloned(),
            revision,
            suns,
            radiance: stages(shaders, &RADIANCE_STAGES, values),
            prefilter: stages(shaders, &PREFILTER_STAGES, values),
            sheen: stages(shaders, &SHEEN_STAGES, values),
        }
    }

    /// See [`TablesKey::resolve`].
    pub(crate) fn resolve(&self) {
        [&self.radiance, &self.prefilter, &self.sheen].into_iter().for_each(|stages| resolve(stages));
    }

    /// The bytes of the block `Params`. Empty for a tree without the stages of a bake.
    pub(crate) fn params(&self) -> &[u8] {
        self.radiance.first().map_or(&[], |stage| &stage.params)
    }

    fn has_map_of(&self, other: &Self) -> bool {
        let of = |key: &Self| (key.revision, key.suns);
        (&self.name, &self.of_model) == (&other.name, &other.of_model) && of(self) == of(other)
    }

    /// Whether the cube map and the irradiance are the same.
    pub(crate) fn has_radiance_of(&self, other: &Self) -> bool {
        self.has_map_of(other) && self.radiance == other.radiance
    }

    /// Whether both differ at most by values of parameters, as two steps of a slider do.
    pub(crate) fn is_step_of(&self, other: &Self) -> bool {
        self.has_map_of(other)
            && same_modules(&self.radiance, &other.radiance)
            && same_modules(&self.prefilter, &other.prefilter)
            && same_modules(&self.sheen, &other.sheen)
    }

    /// Whether both use the same map, suns and models, so that they differ by an edit of the shaders or of the file at most.
    pub(crate) fn is_edit_of(&self, other: &Self) -> bool {
        (&self.name, &self.of_model, self.suns) == (&other.name, &other.of_model, other.suns)
            && same_constants(&self.prefilter, &other.prefilter)
            && same_constants(&self.sheen, &other.sheen)
    }
}

fn resolve(stages: &[BakeStage]) {
    for stage in stages {
        stage.module();
    }
}

fn same_modules(a: &[BakeStage], b: &[BakeStage]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.has_module_of(b))
}

fn same_constants(a: &[BakeStage], b: &[BakeStage]) -> bool {
    a.iter().map(|stage| &stage.constants).eq(b.iter().map(|stage| &stage.constants))
}
