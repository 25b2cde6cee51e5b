//! Evaluates operations on 32-bit integers and booleans.

use super::module::Id;
use super::op::Op;

/// The result of an operation; `None` if it is not supported or an operand is unknown.
pub fn evaluate(op: Op, operands: &[u32], lookup: &dyn Fn(Id) -> Option<u32>) -> Option<u32> {
    let value = |index: usize| operands.get(index).and_then(|id| lookup(*id));
    let (a, b) = (value(0)?, value(1));
    let (signed_a, signed_b) = (a.cast_signed(), b.map(u32::cast_signed));
    Some(match op {
        Op::IAdd => a.wrapping_add(b?),
        Op::ISub => a.wrapping_sub(b?),
        Op::IMul => a.wrapping_mul(b?),
        Op::LogicalEqual | Op::IEqual => u32::from(a == b?),
        Op::LogicalNotEqual | Op::INotEqual => u32::from(a != b?),
        Op::LogicalOr => u32::from(a != 0 || b? != 0),
        Op::LogicalAnd => u32::from(a != 0 && b? != 0),
        Op::LogicalNot => u32::from(a == 0),
        Op::Select if a != 0 => b?,
        Op::Select => value(2)?,
        Op::UGreaterThan => u32::from(a > b?),
        Op::SGreaterThan => u32::from(signed_a > signed_b?),
        Op::UGreaterThanEqual => u32::from(a >= b?),
        Op::SGreaterThanEqual => u32::from(signed_a >= signed_b?),
        Op::ULessThan => u32::from(a < b?),
        Op::SLessThan => u32::from(signed_a < signed_b?),
        Op::ULessThanEqual => u32::from(a <= b?),
        Op::SLessThanEqual => u32::from(signed_a <= signed_b?),
        Op::BitwiseOr => a | b?,
        Op::BitwiseXor => a ^ b?,
        Op::BitwiseAnd => a & b?,
        Op::Not => !a,
        _ => return None,
    })
}
