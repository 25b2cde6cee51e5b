//! Derivatives and implicit levels of detail, which are undefined unless all invocations of a quad run along (SPIR-V 1.6, section 2.20;
//! GLSL 4.60, section 8.14.1).
//!
//! Which invocations run is known at run time alone. A function of the module's own text compares those of the quad with those that
//! have begun. An invocation that discards its fragment is gone as well, which is no fault, so the others are only told at the end, if the
//! missing one is still there: it took another way.

use super::{Checker, MOST_DERIVATIVES, Report, Rule};
use crate::shader::spirv::module::{Id, Instruction, Type};
use crate::shader::spirv::op::{Class, Op};

/// Whether an instruction needs its neighbors.
fn needs_quad(op: Op) -> bool {
    let samples = matches!(
        op,
        Op::ImageSampleImplicitLod
            | Op::ImageSampleDrefImplicitLod
            | Op::ImageSampleProjImplicitLod
            | Op::ImageSampleProjDrefImplicitLod
            | Op::ImageQueryLod
    );
    samples || (Op::DPdx..=Op::FwidthCoarse).contains(&op)
}

impl Checker<'_> {
    /// The invocations of the quad that do not run along, as bits. The level of an image with one level is always that one, so there are
    /// none.
    fn missing(&mut self, out: &mut Vec<Instruction>, i: Instruction, gone: Id) -> Id {
        let uint = self.uint;
        let missing = self.module.emit(out, Op::FunctionCall, uint, &[gone]);
        let sampled = self.module[i].get(3).copied().filter(|_| i.op.class() == Class::Sample);
        let image = sampled.and_then(|sampled| match self.module.get_type(self.module.type_of(sampled)) {
            Some(Type::SampledImage { image }) => Some((sampled, image)),
            _ => None,
        });
        let Some((sampled, image)) = image else { return missing };
        let int = self.module.declare(Op::TypeInt, &[32, 1]);
        let bool = self.module.declare(Op::TypeBool, &[]);
        let [one, zero] = [self.module.constant(int, 1), self.module.constant(uint, 0)];
        let image = self.module.emit(out, Op::Image, image, &[sampled]);
        let levels = self.module.emit(out, Op::ImageQueryLevels, int, &[image]);
        let has_levels = self.module.emit(out, Op::SGreaterThan, bool, &[levels, one]);
        self.module.emit(out, Op::Select, uint, &[has_levels, missing, zero])
    }

    /// Checks a derivative.
    pub(super) fn derivative(&mut self, out: &mut Vec<Instruction>, i: Instruction, (file, line): (String, u32)) {
        let Some((gone, quads)) = self.quads.names.filter(|_| needs_quad(i.op)) else { return };
        if self.quads.count == MOST_DERIVATIVES || !self.push_check((file, line), Rule::Derivative) {
            self.left_out += 1;
            return;
        }
        let number = self.checks.len() as u32 - 1;
        let place = self.quads.count as u32;
        self.quads.count += 1;
        let missing = self.missing(out, i, gone);
        let (m, uint) = (&mut *self.module, self.uint);
        let bool = m.declare(Op::TypeBool, &[]);
        let zero = m.constant(uint, 0);
        match self.to {
            Report::Bits { .. } => {
                let [at, number] = [place, (number + 1) << 4].map(|bits| m.constant(uint, bits));
                let class = m.pointer(m.type_of(quads)).map_or(0, |(class, _)| class);
                let pointer = m.declare(Op::TypePointer, &[class, uint]);
                let is_missing = m.emit(out, Op::INotEqual, bool, &[missing, zero]);
                let both = m.emit(out, Op::BitwiseOr, uint, &[missing, number]);
                let added = m.emit(out, Op::Select, uint, &[is_missing, both, zero]);
                let place = m.emit(out, Op::AccessChain, pointer, &[quads, at]);
                let before = m.emit(out, Op::Load, uint, &[place]);
                let now = m.emit(out, Op::BitwiseOr, uint, &[before, added]);
                out.push(m.make(Op::Store, &[place, now]));
            }
            Report::Operands { function, chosen, .. } if chosen.contains(&(number as usize)) => {
                let is_missing = m.emit(out, Op::INotEqual, bool, &[missing, zero]);
                let number = m.constant(uint, number + 1);
                let told = m.emit(out, Op::Select, uint, &[is_missing, number, zero]);
                let uvec4 = self.uvec4;
                let nothing = m.emit(out, Op::CompositeConstruct, uvec4, &[zero; 4]);
                let void = self.void;
                m.emit(out, Op::FunctionCall, void, &[function, told, nothing]);
            }
            Report::Operands { .. } => {}
        }
    }
}
