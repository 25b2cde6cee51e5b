//! Refuses resources that nothing binds for a stage, at the line that reads them.

use std::collections::{BTreeMap, BTreeSet};

use crate::interface::{Resource, StageRole, block};
use crate::shader::compile::Compiler;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::{find_word, lines};
use crate::shader::source::TreePath;
use crate::shader::spirv::reach::{Used, line_of};
use crate::shader::spirv::reflect::Reflection;

use super::Texts;

/// A stage together with what it is run for.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    /// The purpose that the stage is run for.
    pub role: StageRole,
    /// Its declarations.
    pub reflection: &'a Reflection,
    /// Its source text.
    pub texts: Texts<'a>,
}

/// An error for each place at which a stage reads a resource that is not bound there. A place that several stages run is named once.
pub fn check_access<'a>(runs: impl IntoIterator<Item = Run<'a>>, compiler: &Compiler) -> Vec<Diagnostic> {
    let mut errors: Vec<Diagnostic> = Vec::new();
    let mut seen = BTreeSet::new();
    for run in runs {
        let unbound = run.reflection.reached.iter().filter_map(|used| Some((*used, resource_of(*used)?)));
        let unbound: BTreeMap<Resource, Used> =
            unbound.filter(|(_, resource)| !run.role.binds(*resource)).map(|(used, of)| (of, used)).collect();
        if unbound.is_empty() {
            continue;
        }
        let words = compiler.compile_with_lines(run.texts.snapshot, run.texts.stage).unwrap_or_default();
        for (resource, used) in unbound {
            let error = error(run, resource, used, &words);
            if seen.insert((error.file.clone(), error.line, resource)) {
                errors.push(error);
            }
        }
    }
    errors
}

/// The resource of the contract behind a descriptor; `None` for what Specula adds to stages, and for what is not in the contract.
pub fn resource_of(used: Used) -> Option<Resource> {
    match used {
        Used::Descriptor(set, binding) => Resource::at(set, binding),
        Used::PushConstants => Some(Resource::Draw),
    }
}

fn error(run: Run<'_>, resource: Resource, used: Used, words: &[u32]) -> Diagnostic {
    let Run { role, reflection, texts } = run;
    let (stage, snapshot) = (texts.stage, texts.snapshot);
    let found = line_of(words, used).map(|(file, line)| (TreePath::from(file.as_str()), line));
    let file = found.as_ref().map_or(stage, |(file, _)| file);
    let text = snapshot.read(file).unwrap_or_default();
    let source = found.as_ref().and_then(|(_, line)| lines(&text).into_iter().find(|l| l.number == *line));
    let names = names_of(reflection, used);
    let place = source.as_ref().and_then(|line| names.iter().find_map(|name| find_word(&line.code, name)));
    let word = source.as_ref().zip(place.clone()).map(|(line, at)| line.code[at].to_owned());
    let read = word.or_else(|| names.first().cloned()).unwrap_or_else(|| resource.name().to_owned());
    let message = format!("{stage} reads `{read}` here: {} has no {}", role.name(), resource.name());
    let error = Diagnostic::error(snapshot.display_path(file), message);
    let error = match (&source, place) {
        (Some(line), Some(at)) => error.on_line(line.number, Some(line.raw)).under(at),
        (Some(line), None) => error.on_line(line.number, Some(line.raw)),
        (None, _) => error,
    };
    error.with_help(help(role, resource, file != stage))
}

/// The names by which GLSL reads the resource: of the variable, of the block, of the block's members.
fn names_of(reflection: &Reflection, used: Used) -> Vec<String> {
    let declared = match used {
        Used::Descriptor(set, binding) => reflection.descriptor(set, binding).map(|found| (&found.name, &found.block)),
        Used::PushConstants => {
            reflection.push_constants.as_ref().map(|block| (&block.name, &reflection.push_constants))
        }
    };
    let Some((name, declared)) = declared else { return Vec::new() };
    let instance = block(name).map(|known| known.around[1].to_owned()).filter(|instance| !instance.is_empty());
    let members = declared.iter().flat_map(|block| block.members.iter().map(|member| member.name.clone()));
    instance.into_iter().chain([name.clone()]).chain(members).collect()
}

fn help(role: StageRole, resource: Resource, is_library: bool) -> &'static str {
    match (role, resource) {
        (StageRole::Bake | StageRole::Measure, _) if is_library => {
            "bakes and measurements run this function as well as the picture: give it what it needs as a parameter \
             (a member of `Params` in user/params.glsl with //@ui) or a constant with //@ui"
        }
        (StageRole::Bake | StageRole::Measure, _) => {
            "it can read parameters (user/params.glsl), constants with //@ui and `task`"
        }
        (StageRole::Deform, _) => {
            "it can read parameters (user/params.glsl), constants with //@ui and the instances in BINDING_DEFORMATIONS"
        }
        (_, Resource::Deformations) => "only deform.comp moves vertices; others read the moved ones",
        (_, Resource::Scene) => "only paths.frag has the scene that rays are traced through",
        (_, Resource::Task) => {
            "`task` belongs to the compute stages in ibl/ and measure/; passes have `pass` and `frame`"
        }
        (StageRole::Quads, _) => {
            "place the corner gl_VertexIndex of the quad gl_InstanceIndex, and color it, without this file"
        }
        _ => {
            "draw the model (draw=model in a //@pass), or read the images of its surface by name: normal, base_color, \
             roughness_metallic"
        }
    }
}
