//! The author's `assert()` and `print()`, which are calls of functions without effect.

use super::Checker;
use super::rule::Rule;
use super::suspect::Suspect;
use crate::shader::spirv::module::{Id, Instruction};
use crate::shader::spirv::op::Op;

impl Checker<'_> {
    /// The suspect of a call of `assert` or `print`. An assertion shows the operands of its comparison.
    pub(super) fn own_statement(&mut self, out: &mut Vec<Instruction>, i: Instruction) -> Option<Suspect> {
        if i.op != Op::FunctionCall {
            return None;
        }
        let (callee, arguments) = (self.module[i][3], self.module[i][4..].to_vec());
        match arguments[..] {
            [condition, ..] if self.asserts.contains(&callee) => {
                let text = arguments.get(1).and_then(|text| self.module.number(*text));
                let bool = self.module.declare(Op::TypeBool, &[]);
                let broken = self.module.emit(out, Op::LogicalNot, bool, &[condition]);
                Some(Suspect {
                    rule: Rule::Assert,
                    broken,
                    operands: self.compared(condition),
                    name: String::new(),
                    text,
                })
            }
            [text, value] if self.prints.contains(&callee) => {
                let bool = self.module.declare(Op::TypeBool, &[]);
                let broken = self.module.declare(Op::ConstantTrue, &[bool]);
                Some(Suspect {
                    rule: Rule::Print,
                    broken,
                    operands: vec![value],
                    name: String::new(),
                    text: self.module.number(text),
                })
            }
            _ => None,
        }
    }

    /// The numbers that a condition compares, or itself.
    fn compared(&self, condition: Id) -> Vec<Id> {
        let Some(i) = self.module.definition(condition) else { return Vec::new() };
        let compares = (Op::IEqual..=Op::FUnordGreaterThanEqual).contains(&i.op);
        let is_test = matches!(i.op, Op::IsNan | Op::IsInf | Op::Any | Op::All | Op::LogicalNot);
        let operands = &self.module[i][3..];
        match i.op {
            _ if compares => operands.to_vec(),
            _ if is_test => operands.iter().flat_map(|operand| self.compared(*operand)).collect(),
            Op::LogicalAnd | Op::LogicalOr => operands.iter().flat_map(|operand| self.compared(*operand)).collect(),
            _ => Vec::new(),
        }
    }
}
