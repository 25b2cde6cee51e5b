//! Variables that a shader reads before it sets them start at 0, as in a browser. Without an initial value they hold what was in
//! memory, other values in each run.

use foldhash::{HashMap, HashMapExt};

use super::enums::storage;
use super::module::{Id, Instruction, Module, Type};
use super::op::Op;

/// A composite with more parts is the null constant of its type, which the optimizer does not take apart.
const MOST_PARTS: u32 = 128;

/// Gives each private variable and each variable of a function an initial value of 0, unless it has one or its first use sets it.
pub fn initialize(module: &mut Module) {
    let mut zeros = Zeros(HashMap::new());
    let mut globals = module.globals.clone();
    for i in &mut globals {
        if i.op == Op::Variable && module[*i][3..] == [storage::PRIVATE] {
            *i = zeros.initialized(module, *i);
        }
    }
    // The zeros were declared meanwhile, behind the others. Each constant comes before the variable that uses it.
    let declared = module.globals.split_off(globals.len());
    let (variables, others) = globals.into_iter().partition(|i| i.op == Op::Variable);
    let (mut variables, others): (Vec<Instruction>, Vec<Instruction>) = (variables, others);
    module.globals = others;
    module.globals.extend(declared);
    module.globals.append(&mut variables);
    let mut functions = std::mem::take(&mut module.functions);
    for function in &mut functions {
        let is_set = set_at_once(module, function.blocks.iter().map(|block| block.body.as_slice()));
        for i in function.blocks.iter_mut().take(1).flat_map(|block| &mut block.body) {
            if i.op == Op::Variable && module[*i].len() == 4 && !is_set.contains_key(&module[*i][2]) {
                *i = zeros.initialized(module, *i);
            }
        }
    }
    module.functions = functions;
}

/// The variables that are used in one block alone, whose first use there stores all of them.
fn set_at_once<'a>(module: &Module, blocks: impl Iterator<Item = &'a [Instruction]>) -> HashMap<Id, usize> {
    // The block of each variable whose uses so far are of this kind; `None` for others.
    let mut found: HashMap<Id, Option<usize>> = HashMap::new();
    for (block, body) in blocks.enumerate() {
        for i in body {
            if i.op == Op::Variable {
                continue;
            }
            for id in module.ids_of(*i).filter(|id| module.defined(Op::Variable, *id).is_some()) {
                let is_store = i.op == Op::Store && module[*i][1] == id && module[*i][2] != id;
                let place = found.entry(id).or_insert_with(|| is_store.then_some(block));
                *place = place.filter(|first| *first == block);
            }
        }
    }
    found.into_iter().filter_map(|(id, block)| Some((id, block?))).collect()
}

/// The zeros of types.
struct Zeros(HashMap<Id, Option<Id>>);

impl Zeros {
    /// The variable with an initial value. One whose type has no zero stays as it is.
    fn initialized(&mut self, module: &mut Module, variable: Instruction) -> Instruction {
        let of = module.pointer(module[variable][1]).map(|(_, of)| of);
        let Some(zero) = of.and_then(|of| self.zero(module, of)) else { return variable };
        let operands = [&module[variable][1..], &[zero]].concat();
        module.make(Op::Variable, &operands)
    }

    fn zero(&mut self, module: &mut Module, kind: Id) -> Option<Id> {
        if let Some(known) = self.0.get(&kind) {
            return *known;
        }
        let composite = |this: &mut Self, module: &mut Module, parts: &[Id]| {
            let parts: Vec<Id> = parts.iter().map(|part| this.zero(module, *part)).collect::<Option<_>>()?;
            Some(module.declare(Op::ConstantComposite, &[&[kind], parts.as_slice()].concat()))
        };
        let zero = match module.get_type(kind) {
            Some(Type::Bool) => Some(module.declare(Op::ConstantFalse, &[kind])),
            Some(Type::Int { bits: 32, .. } | Type::Float { bits: 32 }) => Some(module.constant(kind, 0)),
            Some(Type::Int { .. } | Type::Float { .. }) => Some(module.declare(Op::ConstantNull, &[kind])),
            Some(Type::Vector { of, count } | Type::Matrix { column: of, count }) => {
                composite(self, module, &vec![of; count as usize])
            }
            Some(Type::Struct { members }) => {
                let members = members.to_vec();
                composite(self, module, &members)
            }
            Some(Type::Array { of, length }) => match module.number(length) {
                Some(count) if count <= MOST_PARTS => composite(self, module, &vec![of; count as usize]),
                Some(_) => self.zero(module, of).map(|_| module.declare(Op::ConstantNull, &[kind])),
                // The length is a specialization constant.
                None => None,
            },
            // Pointers, ray queries and others have no zero.
            _ => None,
        };
        self.0.insert(kind, zero);
        zero
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::compile::Compiler;
    use crate::shader::source::Source;
    use crate::shader::source::snapshot::Snapshot;
    use crate::shader::spirv::optimize;
    use crate::shader::spirv::validate::validate;

    #[test]
    fn variables_that_are_read_first_have_a_zero() {
        let text = "#version 460\nlayout(location = 0) out vec4 color;\nlayout(location = 1) in flat int at;\n\
            struct S { vec2 a; mat3 b; bool c; };\nfloat unset;\nfloat big[300];\n\
            void add(out vec3 c) { c += 0.5; }\n\
            void main() { float set = 2.0; vec3 c; S s; add(c); float four[4]; bool first; \
            color = vec4(c, s.b[1].y + unset + set + four[at] + big[at]); if (first || s.c) color.x = 0.0; }\n";
        let source = Source::memory([("m.frag", text)]);
        let words = Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.frag".into()).result.unwrap();
        let mut module = Module::parse(&words).unwrap();
        initialize(&mut module);
        let unset = |module: &Module| {
            let all: Vec<Instruction> = module.globals.iter().copied().chain(module.code()).collect();
            let unset = all.into_iter().filter(|i| i.op == Op::Variable && module[*i].len() == 4);
            let own = unset.filter(|i| matches!(module[*i][3], storage::PRIVATE | storage::FUNCTION));
            own.filter_map(|i| module.name(module[i][2])).collect::<Vec<_>>()
        };
        assert_eq!(unset(&module), ["set", "c"]);
        let words = module.write();
        assert_eq!(validate(&words), Ok(()));
        let optimized = optimize(words);
        assert_eq!(validate(&optimized), Ok(()));
        assert!(Module::parse(&optimized).unwrap().globals.iter().all(|i| i.op != Op::Undef));
    }
}
