//! Specializes a module before the driver sees it: sets the constants, takes the branches that they decide, and drops
//! functions that nothing calls anymore.
//!
//! A driver does the same, but most inline every function first. In a shader whose debug modes and material extensions
//! all depend on constants, that is four times the code that a pipeline keeps. See the SPIR-V specification, section
//! 2.11, for the rules of structured control flow, and section 3.52 for the opcodes.

pub(super) mod control_flow;
mod several;

use foldhash::{HashMap, HashSet, HashSetExt};

use super::opcode as op;
use control_flow::Function;
pub use several::specialize_several;

const SPEC_ID: u32 = 1;
/// Words before the first instruction of a module.
pub(super) const HEADER: usize = 5;

pub(super) type Id = u32;
pub(super) type Instruction = Vec<u32>;

pub(super) fn opcode(instruction: &[u32]) -> u32 {
    instruction[0] & 0xffff
}

pub(super) fn instruction(opcode: u32, operands: &[u32]) -> Instruction {
    let mut words = vec![(operands.len() as u32 + 1) << 16 | opcode];
    words.extend_from_slice(operands);
    words
}

/// Returns the module with these values (`constant_id` and the four bytes) for its specialization constants; the others
/// get their defaults. Returns words that are not valid SPIR-V unchanged.
pub fn specialize(words: &[u32], values: &[(u32, u32)]) -> Vec<u32> {
    specialized(words, values).unwrap_or_else(|| words.to_vec())
}

/// The instructions of a module; `None` if one is truncated.
pub(super) fn instructions(words: &[u32]) -> Option<Vec<&[u32]>> {
    let mut rest = words.get(HEADER..)?;
    let mut all: Vec<&[u32]> = Vec::new();
    while let Some(first) = rest.first() {
        let length = (first >> 16) as usize;
        all.push(rest.get(..length).filter(|i| !i.is_empty())?);
        rest = &rest[length..];
    }
    Some(all)
}

/// The position of the first function among the instructions of a module.
pub(super) fn first_function(all: &[&[u32]]) -> usize {
    all.iter().position(|i| opcode(i) == op::FUNCTION).unwrap_or(all.len())
}

/// `None` if an instruction is truncated.
fn specialized(words: &[u32], values: &[(u32, u32)]) -> Option<Vec<u32>> {
    let all = instructions(words)?;
    let (globals, code) = all.split_at(first_function(&all));
    let mut known = Known::default();
    let mut globals = known.globals(globals, values)?;
    let mut functions: Vec<Function> =
        code.split_inclusive(|i| opcode(i) == op::FUNCTION_END).map(Function::parse).collect::<Option<_>>()?;
    fold(&mut functions, &mut known, &mut globals, HashSet::new())?;
    let mut out = words[..HEADER].to_vec();
    out.extend(globals.iter().flatten());
    functions.iter().for_each(|f| f.write(&mut out));
    Some(out)
}

/// Takes the branches that known values decide. Drops the functions that the entry point no longer reaches, and the names and
/// decorations of everything that is dropped. `removed`: ids that were dropped before.
fn fold(
    functions: &mut Vec<Function>,
    known: &mut Known,
    globals: &mut Vec<Instruction>,
    mut removed: HashSet<Id>,
) -> Option<()> {
    known.returned = functions.iter().filter_map(|f| Some((f.id, f.constant(known)?))).collect();
    for function in functions.iter_mut() {
        function.fold(known, &mut removed);
    }
    let entry = globals.iter().find(|i| opcode(i) == op::ENTRY_POINT)?.get(2).copied()?;
    let (mut called, mut open) = (HashSet::from_iter([entry]), vec![entry]);
    while let Some(id) = open.pop() {
        let calls = functions.iter().filter(|f| f.id == id).flat_map(Function::calls);
        open.extend(calls.filter(|id| called.insert(*id)).collect::<Vec<_>>());
    }
    for function in functions.iter().filter(|f| !called.contains(&f.id)) {
        function.results(&mut removed);
    }
    functions.retain(|f| called.contains(&f.id));
    globals.retain(|i| match opcode(i) {
        op::NAME | op::DECORATE => i.get(1).is_some_and(|target| !removed.contains(target)),
        _ => true,
    });
    Some(())
}

/// Values known at compile time.
#[derive(Default)]
pub(super) struct Known {
    pub(super) values: HashMap<Id, u32>,
    /// Return values, by function.
    returned: HashMap<Id, u32>,
}

impl Known {
    /// Rewrites everything before the first function, with plain constants in place of specialization constants.
    fn globals(&mut self, globals: &[&[u32]], values: &[(u32, u32)]) -> Option<Vec<Instruction>> {
        let is_spec_id = |i: &&&[u32]| opcode(i) == op::DECORATE && i.get(2) == Some(&SPEC_ID);
        let ids: HashMap<Id, u32> =
            globals.iter().filter(is_spec_id).filter_map(|i| Some((*i.get(1)?, *i.get(3)?))).collect();
        let given = |id: Id| values.iter().find(|(spec, _)| ids.get(&id) == Some(spec)).map(|(_, value)| *value);
        let mut bools = HashSet::new();
        let mut out = Vec::new();
        for i in globals {
            let (kind, result) = (i.get(1).copied(), i.get(2).copied());
            let value = match opcode(i) {
                op::TYPE_BOOL => {
                    bools.insert(kind?);
                    None
                }
                op::CONSTANT_TRUE => self.learn(result?, 1),
                op::CONSTANT_FALSE => self.learn(result?, 0),
                op::CONSTANT if i.len() == 4 => self.learn(result?, i[3]),
                op::SPEC_CONSTANT_TRUE => Some(given(result?).unwrap_or(1)),
                op::SPEC_CONSTANT_FALSE => Some(given(result?).unwrap_or(0)),
                op::SPEC_CONSTANT if i.len() == 4 => Some(given(result?).unwrap_or(i[3])),
                op::SPEC_CONSTANT_OP => evaluate(*i.get(3)?, i.get(4..)?, &|id| self.values.get(&id).copied()),
                _ => None,
            };
            // A constant with a value needs no SpecId.
            if is_spec_id(&i) {
                continue;
            }
            match (value, kind, result) {
                (Some(value), Some(kind), Some(result)) => {
                    self.values.insert(result, value);
                    out.push(match (bools.contains(&kind), value) {
                        (true, 0) => instruction(op::CONSTANT_FALSE, &[kind, result]),
                        (true, _) => instruction(op::CONSTANT_TRUE, &[kind, result]),
                        (false, value) => instruction(op::CONSTANT, &[kind, result, value]),
                    });
                }
                _ => out.push(i.to_vec()),
            }
        }
        Some(out)
    }

    /// Records a value whose instruction stays as it is.
    fn learn(&mut self, id: Id, value: u32) -> Option<u32> {
        self.values.insert(id, value);
        None
    }
}

/// Evaluates an operation on 32-bit integers and booleans; `None` if it is not supported or an operand is unknown.
pub(super) fn evaluate(operation: u32, operands: &[u32], lookup: &dyn Fn(Id) -> Option<u32>) -> Option<u32> {
    let value = |index: usize| operands.get(index).and_then(|id| lookup(*id));
    let (a, b) = (value(0)?, value(1));
    let (signed_a, signed_b) = (a.cast_signed(), b.map(u32::cast_signed));
    Some(match operation {
        128 => a.wrapping_add(b?),
        130 => a.wrapping_sub(b?),
        132 => a.wrapping_mul(b?),
        164 | 170 => u32::from(a == b?),
        165 | 171 => u32::from(a != b?),
        166 => u32::from(a != 0 || b? != 0),
        167 => u32::from(a != 0 && b? != 0),
        168 => u32::from(a == 0),
        169 => {
            if a != 0 {
                b?
            } else {
                value(2)?
            }
        }
        172 => u32::from(a > b?),
        173 => u32::from(signed_a > signed_b?),
        174 => u32::from(a >= b?),
        175 => u32::from(signed_a >= signed_b?),
        176 => u32::from(a < b?),
        177 => u32::from(signed_a < signed_b?),
        178 => u32::from(a <= b?),
        179 => u32::from(signed_a <= signed_b?),
        197 => a | b?,
        198 => a ^ b?,
        199 => a & b?,
        200 => !a,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::compile::Compiler;
    use crate::shader::source::Source;
    use crate::shader::source::snapshot::Snapshot;

    const TEXT: &str = "#version 460
        layout(constant_id = 7) const uint KIND = 1u;
        layout(constant_id = 8) const bool TWICE = false;
        layout(location = 0) in vec4 x;
        layout(location = 0) out vec4 color;
        const bool IS_SECOND = KIND == 2u;
        bool is_third() { return KIND == 3u; }
        vec4 first() { return sin(x); }
        vec4 second() { vec4 y = x; for (int i = 0; i < 4; ++i) { if (y.x > 2.0) break; y = cos(y); } return y; }
        vec4 third() { return exp(x); }
        void main() {
            if (IS_SECOND && x.y > 0.0) color = second();
            else if (is_third()) { color = third(); return; }
            else color = first();
            if (TWICE) color *= 2.0;
        }";

    fn module() -> Vec<u32> {
        let source = Source::memory([("m.frag", TEXT)]);
        Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.frag".into()).result.unwrap()
    }

    fn opcodes(words: &[u32]) -> Vec<u32> {
        let (mut at, mut out) = (HEADER, Vec::new());
        while at < words.len() {
            out.push(words[at] & 0xffff);
            at += (words[at] >> 16) as usize;
        }
        assert_eq!(at, words.len());
        out
    }

    /// The GLSL.std.450 functions that the module calls.
    fn extended(words: &[u32]) -> Vec<u32> {
        const EXT_INST: u32 = 12;
        let (mut at, mut out) = (HEADER, Vec::new());
        while at < words.len() {
            if words[at] & 0xffff == EXT_INST {
                out.push(words[at + 4]);
            }
            at += (words[at] >> 16) as usize;
        }
        out
    }

    fn count(words: &[u32], opcode: u32) -> usize {
        opcodes(words).into_iter().filter(|found| *found == opcode).count()
    }

    #[test]
    fn only_what_the_values_choose_is_left() {
        let module = module();
        assert_eq!(count(&module, op::FUNCTION), 5);
        // GLSL.std.450: sin is 13, cos 14, exp 27.
        for (kind, functions, branches, called) in [(1, 3, 0, vec![13]), (2, 4, 3, vec![14, 13]), (3, 3, 0, vec![27])] {
            let folded = specialize(&module, &[(7, kind)]);
            // main, the function it calls, and is_third, whose call remains.
            assert_eq!(count(&folded, op::FUNCTION), functions, "kind {kind}");
            assert_eq!(count(&folded, op::BRANCH_CONDITIONAL), branches, "kind {kind}");
            let mut found = extended(&folded);
            found.sort_by_key(|number| called.iter().position(|c| c == number));
            assert_eq!(found, called, "kind {kind}");
            assert_eq!(count(&folded, op::SPEC_CONSTANT), 0);
            assert!(folded.len() < module.len());
        }
    }

    #[test]
    fn several_values_keep_the_code_that_one_of_them_needs() {
        let module = module();
        let both = specialize_several(&module, &[(8, 1)], 7, &[2, 3]).unwrap();
        let mut found = extended(&both);
        found.sort_unstable();
        // first() stays, since second() is taken for x.y > 0 only.
        assert_eq!(found, [13, 14, 27]);
        assert_eq!(count(&both, op::SPEC_CONSTANT) + count(&both, op::SPEC_CONSTANT_OP), 0);
        // The condition of the loop over the values is one more than those of the stage.
        assert_eq!(count(&both, op::LOOP_MERGE), count(&module, op::LOOP_MERGE) + 1);
        let third = specialize_several(&module, &[(8, 1)], 7, &[3, 3]).map(|words| extended(&words));
        assert_eq!(third, None, "values that are the same leave nothing to choose");
        assert_eq!(specialize_several(&module, &[], 9, &[2, 3]), None, "the stage has no such constant");
    }

    #[test]
    fn garbage_comes_back() {
        for words in
            [vec![], vec![1, 2, 3], vec![0x0723_0203, 0, 0, 9, 0, 0], vec![0x0723_0203, 0, 0, 9, 0, 0xffff_0036]]
        {
            assert_eq!(specialize(&words, &[]), words);
        }
    }
}
