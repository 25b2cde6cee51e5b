//! Gives the descriptors that a pass declares by name alone a set of their own, and functions other names.

use std::collections::BTreeSet;

use super::enums::decoration::{BINDING, DESCRIPTOR_SET};
use super::module::Module;
use super::op::{Op, text};

/// Moves the descriptors with these names to `set`. The binding of each is `first` and the place of its name in `names`, so it does
/// not depend on which of them the module uses. The name of a block is that of its type.
pub fn assign_set(words: &mut Vec<u32>, set: u32, first: u32, names: &BTreeSet<String>) {
    let Some(mut module) = Module::parse(words).filter(|_| !names.is_empty()) else { return };
    let place = |id: u32| {
        let name = module.name(id)?;
        names.iter().position(|known| *known == name)
    };
    let mut changes = Vec::new();
    // glslang gives no binding to what no function uses.
    for id in module.decorated(BINDING) {
        let Some(variable) = module.defined(Op::Variable, id) else { continue };
        let of_block = || place(module.pointer(variable[1])?.1);
        let Some(place) = place(id).or_else(of_block) else { continue };
        for (kind, value) in [(BINDING, first + place as u32), (DESCRIPTOR_SET, set)] {
            let is_it = |i: &&super::module::Instruction| i.op == Op::Decorate && module[**i][1..3] == [id, kind];
            changes.extend(module.decorations.iter().find(is_it).map(|i| (*i, value)));
        }
    }
    for (decoration, value) in changes {
        module[decoration][3] = value;
    }
    *words = module.write();
}

/// Gives the functions of a module the names that `renamed` returns for their own.
pub fn rename_functions(words: &mut Vec<u32>, renamed: impl Fn(&str) -> Option<String>) {
    let Some(mut module) = Module::parse(words) else { return };
    for place in 0..module.debug.len() {
        let i = module.debug[place];
        if let Some(name) = (i.op == Op::Name).then(|| renamed(&text(&module[i][2..]))).flatten() {
            let id = module[i][1];
            // A literal string ends in NUL and fills its last word.
            let mut bytes = [name.as_bytes(), &[0]].concat();
            bytes.resize(bytes.len().next_multiple_of(4), 0);
            let letters: Vec<u32> =
                bytes.chunks_exact(4).map(|four| u32::from_le_bytes([four[0], four[1], four[2], four[3]])).collect();
            module.debug[place] = module.make(Op::Name, &[&[id], letters.as_slice()].concat());
        }
    }
    *words = module.write();
}
