//! Makes a [`ShaderSet`] of compiled stages: checks that they fit together and reads their annotations.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::passes::modes_of;
use super::slot::StageSlot;
use super::{Library, Report, ShaderSet, Stage, Update};
use crate::interface::{MODE_FINAL, StageRole};
use crate::shader::annotation::{self, Annotations, Mode};
use crate::shader::compile::StageKind;
use crate::shader::compile::include::files_of;
use crate::shader::contract::access::{Run, check_access};
use crate::shader::contract::{self, Texts};
use crate::shader::diagnostic::{Diagnostic, Severity, unique};
use crate::shader::expression::{self, is_watched};
use crate::shader::glsl::lines;
use crate::shader::graph::{Graph, GraphPass, Input, PassStage, unlike_neighbors};
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::reflect::Reflection;

/// The parts of a set that all stages share.
pub(super) struct Linked {
    annotations: Annotations,
    graph: Graph,
    warnings: Vec<Diagnostic>,
}

/// Drops the modes that show values of a model, which a single file does not draw. Its picture is displayed as it is.
fn keep_modes_of_toys(modes: &mut Vec<Mode>) {
    modes.retain(|mode| mode.id == MODE_FINAL || mode.slug == expression::MODE);
    for mode in modes.iter_mut().filter(|mode| mode.id == MODE_FINAL) {
        (mode.is_displayed, mode.unit) = (true, String::new());
    }
}

impl Library {
    /// Links the stages: all must have compiled, interfaces must match, and annotations must parse. If `is_partial`,
    /// stages that have not compiled are left out, and their annotations are those in the files of their last good
    /// versions.
    pub(super) fn link(&self, snapshot: &Snapshot<'_>, is_partial: bool) -> Result<Linked, Vec<Diagnostic>> {
        // Other errors may be their consequences.
        let mut errors = snapshot.source().problems();
        if !errors.is_empty() {
            return Err(errors);
        }
        let mut warnings = snapshot.source().refusals();
        warnings.extend(snapshot.source().warnings());
        warnings.extend(self.idle_warnings(snapshot));
        warnings.extend(self.stray_warnings(snapshot));
        let mut files = BTreeSet::new();
        let mut modules: BTreeMap<&TreePath, &Stage> = BTreeMap::new();
        // A stage that has never compiled adds the annotations of its files. One that draws an image of its own adds them once it
        // has compiled, since its parameters are its own.
        let is_left_out = |slot: &StageSlot| is_watched(&slot.path) && self.has_broken_watch();
        let may_lack = |slot: &StageSlot| is_partial && !is_left_out(slot);
        let is_unseen = |slot: &&StageSlot| may_lack(slot) && slot.good.is_none() && !slot.is_good();
        let mut replacing = if is_partial { self.replacing(snapshot) } else { BTreeSet::new() };
        replacing.insert(TreePath::from(expression::STAGE));
        let is_shared = |place: usize, path: &TreePath| place < self.fixed || replacing.contains(path);
        let unseen = self.slots.iter().enumerate().filter(|(place, slot)| is_shared(*place, &slot.path));
        let unseen = unseen.map(|(_, slot)| slot).filter(is_unseen);
        let unseen: Vec<TreePath> = unseen.flat_map(|slot| files_of(snapshot, &slot.path)).collect();
        files.extend(&unseen);
        match contract::interface_matches(snapshot) {
            Some(diagnostic) if diagnostic.severity == Severity::Error => errors.push(diagnostic),
            diagnostic => warnings.extend(diagnostic),
        }
        for slot in &self.slots {
            match &slot.current {
                // The error is that of the expression.
                Some(_) if is_left_out(slot) => {}
                Some(Ok(built)) => {
                    files.extend(&built.stage.dependencies);
                    warnings.extend(built.warnings.iter().cloned());
                    modules.insert(&slot.path, &built.stage);
                }
                Some(Err(broken)) if !may_lack(slot) => errors.extend(broken.diagnostics.iter().cloned()),
                Some(Err(_)) | None => {
                    let good = slot.good.iter();
                    files.extend(good.clone().flat_map(|built| &built.stage.dependencies));
                    warnings.extend(good.flat_map(|built| &built.warnings).cloned());
                }
            }
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        // The parameters of passes and what they read stay known while the passes are pending.
        let passes = self.slots.iter().skip(self.fixed);
        let goods = passes.filter_map(|slot| slot.good.as_ref().filter(|_| may_lack(slot)));
        let goods = goods.map(|built| (&built.stage.path, &*built.stage));
        let known: BTreeMap<&TreePath, &Stage> = goods.chain(modules.clone()).collect();
        let reflections: Vec<&Reflection> = known.values().map(|stage| &stage.reflection).collect();
        let mut annotations = annotation::read(snapshot, files, &reflections, !self.is_part).map_err(|errors| {
            // Without one of the built-in passes, what its files declare is unknown, and other files may need it.
            let missing = self.missing_passes(snapshot);
            if missing.is_empty() { errors } else { missing }
        })?;
        if self.source.is_toy() {
            keep_modes_of_toys(&mut annotations.modes);
        }
        // A pass that has never compiled has a name, which other stages may read already.
        let unseen = self.slots.iter().skip(self.fixed).filter(is_unseen);
        let unseen = unseen.filter(|slot| !replacing.contains(&slot.path));
        annotations.passes.extend(unseen.flat_map(|slot| annotation::passes_of(snapshot, &slot.path)));
        let mut watched = known.iter().filter(|(path, _)| is_watched(path));
        let components = watched.find_map(|(_, stage)| expression::components_of(&stage.spirv));
        let declared = known.into_iter().map(|(path, stage)| {
            let texts = stage.texts(snapshot);
            let live = Box::new(|| stage.live_pass_bindings());
            (path.to_string(), PassStage { kind: stage.kind, reflection: &stage.reflection, texts, live })
        });
        let declared: BTreeMap<String, PassStage<'_>> = declared.collect();
        let graph = Graph::new(&annotations, &declared, snapshot)?;
        let pairs = |pass: &Arc<GraphPass>| unlike_stages(pass, &declared);
        let errors: Vec<Diagnostic> = graph.passes.iter().flat_map(pairs).collect();
        if !errors.is_empty() {
            return Err(errors);
        }
        let errors = check_access(runs(&graph, &declared, &modules), &self.compiler);
        if !errors.is_empty() {
            return Err(errors);
        }
        annotations.modes.extend(modes_of(&graph, snapshot));
        annotations.modes.sort_by_key(|mode| mode.id);
        let of_expression = annotations.modes.iter_mut().filter(|mode| mode.slug == expression::MODE);
        of_expression.zip(components).for_each(|(mode, components)| mode.components = components);
        // The parameters of a pass that is still to be compiled are unknown.
        if !is_partial {
            warnings.extend(graph.passes.iter().flat_map(|pass| silent_members(pass, &annotations, &declared)));
        }
        let explained = warnings.into_iter().map(|warning| snapshot.source().explained(warning));
        Ok(Linked { annotations, graph, warnings: unique(explained.collect()) })
    }

    /// Makes a set of the stages that have compiled. The others are pending.
    pub(super) fn commit(
        &mut self,
        linked: Linked,
        generation: u64,
        snapshot: &Snapshot<'_>,
        report: Report,
    ) -> Update {
        let cleared = std::mem::replace(&mut self.failed, false);
        let dependencies = self.dependencies().into_iter();
        let texts: BTreeMap<TreePath, Arc<str>> =
            dependencies.filter_map(|path| snapshot.read(&path).ok().map(|text| (path, text))).collect();
        let author_texts = author_texts(snapshot, &texts);
        let (mut stages, mut pending) = (BTreeMap::new(), BTreeSet::new());
        let has_broken_watch = self.has_broken_watch();
        for slot in &mut self.slots {
            match &slot.current {
                Some(_) if has_broken_watch && is_watched(&slot.path) => slot.good = None,
                Some(Ok(built)) => slot.good = Some(built.clone()),
                Some(Err(_)) | None => {
                    pending.insert(slot.path.to_string());
                }
            }
            if let Some(good) = &slot.good {
                stages.insert(slot.path.to_string(), Arc::clone(&good.stage));
            }
        }
        let Linked { annotations: Annotations { modes, constants, parameters, .. }, graph, warnings } = linked;
        let watched = self.watching();
        let error = watched.as_ref().and_then(|watched| watched.error.as_ref());
        if let Some(set) = &self.set {
            let same_stages = stages.len() == set.stages.len()
                && stages.values().zip(set.stages.values()).all(|(new, old)| Arc::ptr_eq(new, old));
            let same_texts = (&modes, &constants, &parameters, &graph, &warnings)
                == (&set.modes, &set.constants, &set.parameters, &set.graph, &set.warnings);
            if same_stages && same_texts && pending == set.pending && error == set.expression_error() {
                return Update::Unchanged { cleared };
            }
        }
        let tree = self.tree;
        let set = Arc::new(ShaderSet {
            generation,
            tree,
            stages,
            pending,
            modes,
            constants,
            parameters,
            graph,
            warnings,
            texts,
            author_texts,
            watched,
        });
        self.set = Some(Arc::clone(&set));
        Update::Ready(set, report)
    }

    /// Whether a stage of the watched expression does not compile: nothing is left of them all.
    fn has_broken_watch(&self) -> bool {
        self.slots.iter().any(|slot| is_watched(&slot.path) && matches!(slot.current, Some(Err(_))))
    }
}

/// The stages among `compiled`, each with what it is run for. A stage of several passes appears once for each role.
fn runs<'a, 'b: 'a>(
    graph: &Graph,
    declared: &'a BTreeMap<String, PassStage<'b>>,
    compiled: &BTreeMap<&TreePath, &Stage>,
) -> Vec<Run<'a>> {
    let of_passes = graph.passes.iter().flat_map(|pass| pass.stages().map(|path| (path.to_owned(), pass.role())));
    let mut roles: BTreeSet<(String, StageRole)> = of_passes.collect();
    let is_alone = |path: &str| !graph.passes.iter().any(|pass| pass.stages().any(|stage| stage == path));
    let alone = declared.iter().filter(|(path, stage)| stage.kind == StageKind::Compute && is_alone(path));
    roles.extend(alone.map(|(path, _)| (path.clone(), StageRole::of_compute(path))));
    let is_new = |path: &str| compiled.keys().any(|known| known.as_str() == path);
    let run = |(path, role): (String, StageRole)| {
        let stage = declared.get(&path).filter(|_| is_new(&path))?;
        Some(Run { role, reflection: stage.reflection, texts: stage.texts })
    };
    roles.into_iter().filter_map(run).collect()
}

/// Warnings about members of a pass's own uniform block that nothing sets.
fn silent_members(
    pass: &GraphPass,
    annotations: &Annotations,
    stages: &BTreeMap<String, PassStage<'_>>,
) -> Vec<Diagnostic> {
    let members = pass.inputs.values().filter_map(|input| match input {
        Input::Parameters(_, members) => Some(members),
        _ => None,
    });
    let is_set = |name: &str| annotations.parameters.iter().any(|parameter| parameter.name == name);
    let silent = members.flatten().map(|(_, name)| name).filter(|name| !is_set(name));
    let warning = |name: &String| {
        let message =
            format!("`{name}` in a uniform block of the pass `{}` has no //@ui, so it reads as 0", pass.name());
        let help = format!("write it on a line of its own: `float {name}; //@ui \"Label\" 0..1 = 0.5`");
        let at = stages.get(&pass.desc.stage).map(|stage| stage.texts.error(&[name.as_str()], message.clone()));
        let at = at.unwrap_or_else(|| pass.desc.place.error(message));
        Diagnostic { severity: Severity::Warning, ..at }.with_help(help)
    };
    silent.map(warning).collect()
}

/// Errors of a pass with a stage that reads what the stage before it does not write.
fn unlike_stages(pass: &GraphPass, stages: &BTreeMap<String, PassStage<'_>>) -> Vec<Diagnostic> {
    let errors = unlike_neighbors(pass.stages(), stages);
    let Some(fragment) = stages.get(&pass.desc.stage) else { return errors };
    let covering = fragment.texts.snapshot.display_path(&TreePath::from(COVERING));
    let is_about = |error: &Diagnostic| pass.desc.draws_model() && error.file == covering;
    match errors.iter().any(is_about).then(|| includes_covering(pass, fragment.texts)) {
        Some(error) => errors.into_iter().filter(|error| !is_about(error)).chain([error]).collect(),
        None => errors,
    }
}

/// The file that passes include that cover their image.
const COVERING: &str = "pass.glsl";

/// The error about a pass that draws the model and includes pass.glsl.
fn includes_covering(pass: &GraphPass, texts: Texts<'_>) -> Diagnostic {
    let message = format!(
        "{COVERING} is for passes that cover their image: it reads `uv`, which {} does not write",
        pass.pre_rasterization.stages().last().unwrap_or_default()
    );
    let help = "this pass draws the model (draw=model), so include what the vertex stage of the model writes:\n\
        #include \"interface.glsl\"\n#include \"common/fragment.glsl\"\n\
        layout(location = 0) in Fragment fragment;\nlayout(location = 0) out vec4 color;";
    let text = texts.snapshot.read(texts.stage).unwrap_or_default();
    let found = lines(&text).into_iter().find_map(|line| {
        let is_include = line.keyword == Some("include");
        let at = line.code.find(COVERING).filter(|_| is_include)?;
        let error = Diagnostic::error(&pass.desc.place.file, message.clone());
        Some(error.on_line(line.number, Some(line.raw)).under(at..at + COVERING.len()))
    });
    found.unwrap_or_else(|| pass.desc.place.error_at("draw=", message)).with_help(help)
}

/// The texts of files whose authors wrote another text than is compiled: see [`crate::shader::Source::author_text`].
fn author_texts(snapshot: &Snapshot<'_>, texts: &BTreeMap<TreePath, Arc<str>>) -> BTreeMap<TreePath, Arc<str>> {
    let source = snapshot.source();
    if !source.is_toy() {
        return BTreeMap::new();
    }
    let own = |(path, text): (&TreePath, &Arc<str>)| {
        let own: Arc<str> = source.author_text(path).ok()?.into();
        (own != *text).then(|| (path.clone(), own))
    };
    texts.iter().filter_map(own).collect()
}
