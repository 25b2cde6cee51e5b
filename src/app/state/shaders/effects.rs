//! The passes of a shader tree as the user sees them: effects with a switch, passes that only work for others, and the parameters of each.

use crate::shader::{Constant, GraphPass, Parameter, ShaderSet, embedded};

/// Whether the pass belongs to the tree that Specula comes with.
pub(in crate::app) fn is_shipped(pass: &GraphPass) -> bool {
    embedded::has(&pass.desc.stage)
}

/// The passes with a switch of their own.
pub(in crate::app) fn own(shaders: &ShaderSet) -> impl Iterator<Item = &GraphPass> {
    let has_own = |pass: &&GraphPass| pass.desc.when.is_none() && pass.has_switch();
    shaders.graph.passes.iter().map(|pass| &**pass).filter(has_own)
}

/// A pass and those whose images and buffers it needs.
fn needs<'a>(shaders: &'a ShaderSet, pass: &GraphPass) -> impl Iterator<Item = &'a GraphPass> {
    shaders.graph.needed_by(pass.name()).into_iter().map(|index| &*shaders.graph.passes[index])
}

/// The constants that switch passes, in the order of their ids.
pub(in crate::app) fn switches(shaders: &ShaderSet) -> impl Iterator<Item = &Constant> {
    shaders.constants.iter().filter(|constant| is_switch(shaders, &constant.name))
}

/// Whether the constant with this name switches passes.
pub(in crate::app) fn is_switch(shaders: &ShaderSet, constant: &str) -> bool {
    shaders.graph.passes.iter().any(|pass| pass.desc.when.as_deref() == Some(constant))
}

/// Whether a parameter belongs to a pass: it is in the pass's own block, or depends on the pass's switch.
pub(in crate::app) fn is_of_pass(shaders: &ShaderSet, parameter: &Parameter) -> bool {
    parameter.offset.is_none() || parameter.when.as_deref().is_some_and(|when| is_switch(shaders, when))
}

/// The parameters that a constant switches on with its passes.
pub(in crate::app) fn of_switch<'a>(shaders: &'a ShaderSet, switch: &Constant) -> Vec<&'a Parameter> {
    let name = Some(&switch.name);
    let passes: Vec<_> = shaders.graph.passes.iter().filter(|pass| pass.desc.when.as_ref() == name).collect();
    let is_own = |parameter: &&Parameter| {
        let in_block = || passes.iter().any(|pass| parameter.offset.is_none() && pass.has_parameter(&parameter.name));
        parameter.when.as_ref() == name || in_block()
    };
    shaders.parameters.iter().filter(is_own).collect()
}

/// The parameters in the uniform blocks of an effect and of the internal passes that it needs.
pub(in crate::app) fn of_effect<'a>(shaders: &'a ShaderSet, effect: &GraphPass) -> Vec<&'a Parameter> {
    let internal = &shaders.graph.internal;
    let is_its = |pass: &&GraphPass| pass.name() == effect.name() || internal.contains(pass.name());
    let passes: Vec<_> = needs(shaders, effect).filter(|pass| pass.desc.when.is_none()).filter(is_its).collect();
    let in_block = |parameter: &&Parameter| {
        parameter.offset.is_none() && passes.iter().any(|pass| pass.has_parameter(&parameter.name))
    };
    shaders.parameters.iter().filter(in_block).collect()
}
