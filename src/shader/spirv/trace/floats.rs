//! Logs each value of floats once: where a variable, a parameter or the result of a call is only copied, the statement that computed it has
//! logged it before. What the stage before has written is logged where it is read.

use foldhash::{HashSet, HashSetExt};

use super::functions::is_line;
use super::{NumberKind, Place, Purpose, Tracer};
use crate::shader::spirv::enums::storage;
use crate::shader::spirv::module::{Id, Instruction, Type};
use crate::shader::spirv::op::{Class, Op};
use crate::shader::spirv::reach::file_of;

const FLOATS: [NumberKind; 1] = [NumberKind::Float];

/// Whether the values that an instruction uses are logged.
fn is_logged(op: Op) -> bool {
    let compares = (Op::FOrdEqual..=Op::FUnordGreaterThanEqual).contains(&op);
    let is_use = matches!(op, Op::Store | Op::ReturnValue | Op::FunctionCall | Op::ConvertFToU | Op::ConvertFToS);
    is_use || compares || op.class() == Class::Sample
}

impl Tracer<'_> {
    /// The instructions of a block with calls between them, without lines.
    pub(super) fn floats(&mut self, body: &[Instruction]) -> Vec<Instruction> {
        let (mut out, mut line, mut logged) = (Vec::with_capacity(body.len()), None, HashSet::new());
        for &i in body {
            if is_line(i) {
                line = (i.op == Op::Line).then_some(i);
                continue;
            }
            let values = if is_logged(i.op) { self.computed(i) } else { Vec::new() };
            let values: Vec<Id> = values.into_iter().filter(|value| logged.insert(*value)).collect();
            self.log_uses(&mut out, i, line, &values);
            out.push(i);
            if i.op == Op::Load && self.class(self.module[i][3]) == Some(storage::INPUT) {
                let value = self.module[i][2];
                self.log_uses(&mut out, i, line, &[value]);
            }
        }
        out
    }

    /// The storage class that a pointer points to.
    fn class(&self, pointer: Id) -> Option<u32> {
        self.module.pointer(self.module.type_of(pointer)).map(|(class, _)| class)
    }

    /// The values of floats among the operands that no other place logs.
    fn computed(&self, i: Instruction) -> Vec<Id> {
        let result = self.module.result(i);
        let operands = self.module.ids_of(i).filter(|id| Some(*id) != result);
        let has_floats = |id: &Id| self.parts_of(self.module.type_of(*id), &FLOATS) > 0;
        operands.filter(|id| has_floats(id) && self.is_computed(*id)).collect()
    }

    fn is_computed(&self, value: Id) -> bool {
        let Some(i) = self.module.definition(value) else { return false };
        match i.op {
            Op::Load => {
                let own = [storage::FUNCTION, storage::PRIVATE, storage::INPUT, storage::OUTPUT];
                self.class(self.module[i][3]).is_none_or(|class| !own.contains(&class))
            }
            Op::Function | Op::FunctionCall | Op::FunctionParameter | Op::Undef => false,
            op if op.class() == Class::Constant => !self.is_finite(value),
            _ => true,
        }
    }

    /// Whether a constant is finite, as far as it is known.
    fn is_finite(&self, constant: Id) -> bool {
        match self.module.defined(Op::ConstantComposite, constant) {
            Some(words) => words[3..].iter().all(|part| self.is_finite(*part)),
            None => {
                let is_float = matches!(self.module.get_type(self.module.type_of(constant)), Some(Type::Float { .. }));
                !is_float || self.module.number(constant).is_none_or(|bits| f32::from_bits(bits).is_finite())
            }
        }
    }

    /// Appends calls with these values, which an instruction uses. Without a line nobody could find the place.
    fn log_uses(&mut self, out: &mut Vec<Instruction>, i: Instruction, line: Option<Instruction>, values: &[Id]) {
        let line = line.filter(|_| !values.is_empty()).and_then(|line| file_of(self.module, &self.module[line]));
        let Some((file, line)) = line else { return };
        let purpose = match i.op {
            Op::Store => Purpose::Store(self.stored(self.module[i][1]).0),
            Op::ReturnValue => Purpose::Return,
            Op::Load => Purpose::Input(self.stored(self.module[i][3]).0),
            _ => Purpose::Use,
        };
        self.places.push(Place { file, line, purpose });
        values.iter().for_each(|value| self.log_parts(out, *value, &FLOATS, String::new()));
    }
}
