//! Completes a `//@ui` with the id, default or offset that its declaration has in the compiled modules.

use super::place::AnnotationPlace;
use super::ui::{Declared, Ui, outside_of_choices};
use super::{Annotations, Constant, Parameter};
use crate::interface;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::spirv::reflect::{Reflection, Scalar};

/// Combines a `//@ui` with its declaration in the compiled modules.
pub(super) fn resolve(ui: Ui, modules: &[&Reflection], out: &mut Annotations) -> Result<(), Box<Diagnostic>> {
    let Ui {
        name,
        label,
        range,
        choices,
        choice_docs,
        conserves,
        reciprocal,
        color,
        when,
        group,
        doc,
        unit,
        default,
        declared,
        place,
    } = ui;
    let (file, line) = (place.file.clone(), place.line);
    match declared {
        Declared::Constant(_) => {
            let found = modules.iter().flat_map(|module| &module.constants).find(|constant| constant.name == name);
            let Some(found) = found else {
                let message = format!("`{name}` is in no compiled stage, so //@ui cannot set it");
                return Err(Box::new(place.error_at(&name, message)));
            };
            let value = match found.scalar {
                Scalar::Int => f64::from(found.default.cast_signed()),
                _ => f64::from(found.default),
            };
            if let Some(message) = outside_of_choices(&choices, value) {
                return Err(Box::new(place.error_at("choice", message)));
            }
            let (id, scalar, default) = (found.id, found.scalar, found.default);
            out.constants.push(Constant {
                name,
                id,
                label,
                scalar,
                default,
                range,
                choices,
                choice_docs,
                conserves,
                reciprocal,
                group,
                doc,
                unit,
                file,
                line,
            });
        }
        Declared::Member(kind) => {
            let offset = match in_a_pass(&name, modules) {
                true => None,
                false => Some(offset_in_params(&name, modules, &place)?),
            };
            let default = default.unwrap_or_else(|| match choices.first() {
                // Without a default it is 0, or the first choice if 0 is not a choice.
                Some((_, first)) if outside_of_choices(&choices, 0.0).is_some() => vec![*first as f64],
                _ => vec![0.0; kind.components()],
            });
            out.parameters.push(Parameter {
                name,
                label,
                offset,
                kind,
                range,
                default,
                color,
                choices,
                choice_docs,
                when,
                group,
                doc,
                unit,
                file,
                line,
            });
        }
    }
    Ok(())
}

/// Whether `name` is a member of a pass's own uniform block.
fn in_a_pass(name: &str, modules: &[&Reflection]) -> bool {
    let own = modules.iter().flat_map(|module| &module.descriptors).filter(|found| found.set == interface::SET_PASS);
    own.filter_map(|found| found.block.as_ref()).any(|block| block.members.iter().any(|member| member.name == name))
}

/// The offset of a member of `Params`. It must be the same in every module, since all share one buffer.
fn offset_in_params(name: &str, modules: &[&Reflection], place: &AnnotationPlace) -> Result<u32, Box<Diagnostic>> {
    let params = interface::BINDINGS.iter().find(|binding| binding.name == "BINDING_PARAMS");
    let blocks = modules.iter().filter_map(|module| module.descriptor(params?.set, params?.binding)?.block.as_ref());
    let mut offsets: Vec<u32> = blocks
        .flat_map(|block| &block.members)
        .filter(|member| member.name == name)
        .map(|member| member.offset)
        .collect();
    offsets.dedup();
    match offsets.as_slice() {
        [only] => Ok(*only),
        [] => {
            let message =
                format!("`{name}` is no member of the block at SET_FRAME, BINDING_PARAMS in any compiled stage");
            Err(Box::new(place.error_at(name, message)))
        }
        [first, other, ..] => {
            let message = format!("`{name}` is at byte {first} in one stage and at byte {other} in another");
            let help = "declare the Params block once, in a file that all stages include";
            Err(Box::new(place.error_at(name, message).with_help(help)))
        }
    }
}
