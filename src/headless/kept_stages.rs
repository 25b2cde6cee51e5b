//! Stages that log what their statements do, with their pipelines. What was compiled for a version of the shaders is kept for the next pixel.

use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

use super::HeadlessError;
use crate::frame::PipelineRequest;
use crate::pipeline::PipelineSet;
use crate::shader::trace::{LoggingStage, TracedStage};
use crate::shader::{Compiler, ShaderSet, Source, StageKind};

/// Stages that are kept: two of the newest version of the shaders, and of the one before.
const MOST_STAGES: usize = 4;
/// Files of a stage whose pipelines are kept.
const MOST_FILES: usize = 4;
/// Lists of constants for which the files of a stage are kept.
const MOST_CONSTANTS: usize = 64;

/// Lists of constants with which a stage is specialized.
pub(super) type Constants = BTreeSet<Vec<(u32, u32)>>;

/// The constants with which these pipelines specialize a stage.
pub(super) fn constants_of(request: &PipelineRequest, stage: &str) -> Constants {
    let keys = request.keys().filter(|key| key.stages().any(|of| of == stage));
    let mut constants: Constants = keys.map(|key| key.specialization.to_vec()).collect();
    if request.compute_stages().any(|of| of == stage) {
        constants.insert(request.pass_constants().to_vec());
    }
    constants
}

/// The stages, the last used first.
pub(super) struct KeptStages {
    /// The address of the log.
    address: u64,
    traces_vertices: bool,
    kept: VecDeque<KeptStage>,
}

impl KeptStages {
    pub(super) fn new(address: u64, traces_vertices: bool) -> Self {
        Self { address, traces_vertices, kept: VecDeque::new() }
    }

    /// The stage of a version of the shaders, compiled with a log if it is not kept.
    pub(super) fn stage(
        &mut self,
        shaders: &Arc<ShaderSet>,
        stage: &str,
        tools: (&Compiler, &Source),
    ) -> Result<&mut KeptStage, HeadlessError> {
        let is_it = |kept: &KeptStage| Arc::ptr_eq(&kept.shaders, shaders) && kept.stage == *stage;
        let kept = match self.kept.iter().position(is_it).and_then(|at| self.kept.remove(at)) {
            Some(kept) => kept,
            None => {
                let is_vertex = shaders.stages.get(stage).is_some_and(|stage| stage.kind == StageKind::Vertex);
                if is_vertex && !self.traces_vertices {
                    let message = "this device cannot write buffers from vertex stages, which a trace of them needs";
                    return Err(HeadlessError::Settings(message.to_owned()));
                }
                tracing::debug!("{stage}: compiled with a log");
                let logging = LoggingStage::new(shaders, stage, tools, self.address);
                let logging = logging.map_err(HeadlessError::Settings)?;
                let (shaders, stage) = (shaders.clone(), stage.to_owned());
                KeptStage { shaders, stage, logging, files: VecDeque::new(), groups: VecDeque::new() }
            }
        };
        self.kept.push_front(kept);
        self.kept.truncate(MOST_STAGES);
        Ok(&mut self.kept[0])
    }
}

/// A list of constants, and the files whose statements a stage keeps with them.
type FilesOf = (Vec<(u32, u32)>, Vec<String>);

/// A stage that logs, and the statements of groups of its files.
pub(super) struct KeptStage {
    shaders: Arc<ShaderSet>,
    stage: String,
    logging: LoggingStage,
    /// The files whose statements the stage keeps, by a list of constants.
    files: VecDeque<FilesOf>,
    groups: VecDeque<Group>,
}

/// A stage that logs the statements of some files.
pub(super) struct Group {
    files: BTreeSet<String>,
    pub(super) stage: Arc<TracedStage>,
    /// The pipelines of the frame, with this stage.
    pub(super) set: Arc<PipelineSet>,
}

impl KeptStage {
    /// The files whose statements the stage keeps with these constants.
    pub(super) fn files_of(&mut self, constants: &Constants) -> Vec<String> {
        let mut all = BTreeSet::new();
        for list in constants {
            if !self.files.iter().any(|(of, _)| of == list) {
                self.files.push_front((list.clone(), self.logging.files(&[list])));
            }
            all.extend(self.files.iter().filter(|(of, _)| of == list).flat_map(|(_, files)| files.clone()));
        }
        self.files.truncate(MOST_CONSTANTS);
        all.into_iter().collect()
    }

    /// Groups of these files that a module each can log. Without files, all are logged that the stage keeps with these constants.
    pub(super) fn groups(&self, files: &[&str], constants: &Constants) -> Result<Vec<BTreeSet<String>>, HeadlessError> {
        let constants: Vec<&[(u32, u32)]> = constants.iter().map(Vec::as_slice).collect();
        self.logging.groups(files, &constants).map_err(HeadlessError::Settings)
    }

    /// Whether the pipelines of `request` with a log of this file are built.
    pub(super) fn is_built(&self, file: &str, request: impl FnOnce(&Arc<ShaderSet>) -> Arc<PipelineRequest>) -> bool {
        let group = self.groups.iter().find(|group| group.files.len() == 1 && group.files.contains(file));
        group.is_some_and(|group| group.set.has(&request(&group.stage.shaders)))
    }

    /// The stage with a log of these files, and the pipelines of `request` with it in a set that is otherwise `of_picture`. Also how many
    /// pipelines were missing.
    pub(super) fn group(
        &mut self,
        files: &BTreeSet<String>,
        of_picture: &PipelineSet,
        request: impl FnOnce(&Arc<ShaderSet>) -> Arc<PipelineRequest>,
    ) -> Result<(&Group, usize), HeadlessError> {
        let known = self.groups.iter().position(|group| group.files == *files);
        let (group, built) = match known.and_then(|at| self.groups.remove(at)) {
            Some(group) => {
                // Without counting as a request, so that the pipelines of the picture stay.
                let built = group.set.build_aside(&request(&group.stage.shaders))?;
                (group, built)
            }
            None => {
                let stage = Arc::new(self.logging.of(files).map_err(HeadlessError::Settings)?);
                let (set, built) = of_picture.variant(stage.shaders.clone(), &request(&stage.shaders))?;
                (Group { files: files.clone(), stage, set }, built)
            }
        };
        self.groups.push_front(group);
        self.groups.truncate(MOST_FILES);
        Ok((&self.groups[0], built))
    }
}
