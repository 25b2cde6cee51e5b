//! Names of loops: which loop of a module's source ran out of rounds.

use xxhash_rust::xxh3::xxh3_64;

use crate::shader::spirv::opcode as op;
use crate::shader::spirv::operands::text;
use crate::shader::spirv::specialize::{Id, instructions, opcode};

/// The first two of the three words that a bounded module writes to its buffer; both are 0 at first. The third is 1 at
/// first, and 0 once an invocation has used up its budget. (Mesa's lavapipe reads 0 for helper invocations, and would
/// wait for them.)
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Overrun {
    /// The loop that took at least half of an invocation's budget, as [`Place::find`] knows it; 0 if there is none.
    pub one: u32,
    /// A module whose loops used up a budget together; 0 if there is none.
    pub together: u32,
}

/// The loop that an [`Overrun`] names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Number of the loop among the loops of its function before specialization; `None` if several loops used up the
    /// budget together.
    pub number: Option<usize>,
    /// glslang's name of its function, which has the types of the parameters: `f(vf3;`. Empty if it is unknown.
    pub function: String,
}

impl Place {
    /// Finds the loop in a module before specialization. `None` if the overrun is of another module.
    pub fn find(overrun: Overrun, words: &[u32]) -> Option<Self> {
        let seed = seed(words);
        let all = instructions(words)?;
        let (mut label, mut function, mut number) = (0, 0, 0);
        for i in &all {
            match opcode(i) {
                op::FUNCTION => (function, number) = (*i.get(2)?, 0),
                op::LABEL => label = *i.get(1)?,
                op::LOOP_MERGE => {
                    if overrun.one == name(seed, label) {
                        return Some(Self { number: Some(number), function: name_of(&all, function) });
                    }
                    number += 1;
                }
                _ => {}
            }
        }
        let is_module = overrun.one == 0 && overrun.together == name(seed, 0);
        is_module.then(|| Self { number: None, function: String::new() })
    }

    /// The function's name in GLSL.
    pub fn function_in_glsl(&self) -> &str {
        self.function.split('(').next().unwrap_or_default()
    }

    /// File and line of the loop, in a module of the same text that was compiled with debug information. An edit may
    /// have moved functions, so the loop is found by its function.
    pub fn line(&self, words: &[u32]) -> Option<(String, u32)> {
        let all = instructions(words)?;
        let is_function = |i: &&[u32]| opcode(i) == op::FUNCTION && i.len() > 2 && name_of(&all, i[2]) == self.function;
        let start = all.iter().position(is_function)?;
        let body = all[start..].iter().take_while(|i| opcode(i) != op::FUNCTION_END).enumerate();
        let at = start + body.filter(|(_, i)| opcode(i) == op::LOOP_MERGE).nth(self.number?)?.0;
        let line = all[..at].iter().rev().find(|i| opcode(i) == op::LINE)?;
        let file = all.iter().find(|i| opcode(i) == op::STRING && i.get(1) == line.get(1))?;
        Some((text(&file[2..]), *line.get(2)?))
    }
}

/// glslang's name of a function.
fn name_of(all: &[&[u32]], function: Id) -> String {
    let name = all.iter().find(|i| opcode(i) == op::NAME && i.get(1) == Some(&function));
    name.map(|i| text(&i[2..])).unwrap_or_default()
}

/// Identifies a module before specialization.
pub(super) fn seed(words: &[u32]) -> u64 {
    xxh3_64(bytemuck::cast_slice(words))
}

/// The number by which a buffer names the loop with this header; 0 names the module.
pub(super) fn name(seed: u64, header: Id) -> u32 {
    let hash = xxh3_64(&(seed ^ u64::from(header)).to_le_bytes());
    (hash as u32).max(1)
}
