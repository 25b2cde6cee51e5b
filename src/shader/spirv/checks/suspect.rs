//! Operations that may break a rule, and results that are only selected.

use foldhash::{HashMap, HashSet};

use super::rule::Rule;
use crate::shader::spirv::module::{Function, Id, Module};
use crate::shader::spirv::op::Op;

/// An operation that may break a rule.
pub(super) struct Suspect {
    pub rule: Rule,
    /// Whether it does: a bool, or a vector with one for each component.
    pub broken: Id,
    /// The values that it works on, for the reader.
    pub operands: Vec<Id>,
    /// See `Check::name`.
    pub name: String,
    /// See `Check::text`.
    pub text: Option<u32>,
}

impl Suspect {
    /// An operation without a text.
    pub(super) fn new(rule: Rule, broken: Id, operands: &[Id]) -> Self {
        Self { rule, broken, operands: operands.to_vec(), name: String::new(), text: None }
    }
}

/// Results that one select reads, and nothing else.
pub(super) type Selected = HashSet<Id>;

/// The results that a single select in the same block reads, and nothing else. `a ? b : c` computes both sides where that is simple, and
/// the side that is not selected may be undefined.
pub(super) fn selected(module: &Module, function: &Function) -> Selected {
    // How often each result is read, and the blocks of those that a select reads.
    let (mut reads, mut places): (HashMap<Id, usize>, HashMap<Id, usize>) = Default::default();
    let mut made: HashMap<Id, usize> = HashMap::default();
    for (place, block) in function.blocks.iter().enumerate() {
        for i in &block.body {
            let result = module.result(*i);
            made.extend(result.map(|result| (result, place)));
            for id in module.ids_of(*i).filter(|id| Some(*id) != result) {
                *reads.entry(id).or_default() += 1;
            }
            if i.op == Op::Select {
                places.extend([4, 5].map(|side| (module[*i][side], place)));
            }
        }
    }
    places
        .into_iter()
        .filter(|(id, place)| reads.get(id) == Some(&1) && made.get(id) == Some(place))
        .map(|(id, _)| id)
        .collect()
}
