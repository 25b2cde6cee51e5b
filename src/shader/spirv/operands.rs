//! The operands of instructions: which words are ids, and literal strings.

use super::opcode as op;

/// Whether word `at` of an instruction is an id (SPIR-V specification, section 3.52); `None` if the instruction is unknown.
pub(super) fn is_id(i: &[u32], at: usize) -> Option<bool> {
    let all = usize::MAX;
    // How many words are ids. The words behind them are literals.
    let leading = match i[0] & 0xffff {
        // The model, then the function.
        op::ENTRY_POINT => return Some(at == 2),
        op::EXECUTION_MODE => 1,
        op::NO_LINE | op::CAPABILITY | op::EMIT_VERTEX | op::END_PRIMITIVE => 0,
        op::UNDEF | op::CONSTANT_TRUE | op::CONSTANT_FALSE | op::CONSTANT_COMPOSITE | op::CONSTANT_NULL => all,
        // The last is OpSpecConstantComposite.
        op::SPEC_CONSTANT_TRUE | op::SPEC_CONSTANT_FALSE | 51 => all,
        // The set, the number, the operands
        op::EXT_INST => return Some(at != 4),
        // Types: their sizes, counts and formats are literals.
        op::EXT_INST_IMPORT | 19..=22 => 1,
        23..=25 => 2,
        26..=30 | 33 => all,
        op::TYPE_POINTER => return Some(at != 2),
        op::CONSTANT | op::SPEC_CONSTANT => 2,
        // The operation, then its operands; of composites some are literals.
        op::SPEC_CONSTANT_OP => return Some(at <= 2 || (at > 3 && !matches!(i.get(3), Some(79 | 81 | 82)))),
        op::FUNCTION => return Some(at != 3),
        55..=57 => all,
        op::VARIABLE => return Some(at != 3),
        // The rest is the memory access.
        op::LOAD => 3,
        op::STORE => 2,
        op::ACCESS_CHAIN | op::IN_BOUNDS_ACCESS_CHAIN => all,
        op::ARRAY_LENGTH => 3,
        // OpVectorExtractDynamic, OpVectorInsertDynamic
        77 | 78 => all,
        op::VECTOR_SHUFFLE => 4,
        op::COMPOSITE_CONSTRUCT => all,
        op::COMPOSITE_EXTRACT => 3,
        op::COMPOSITE_INSERT => 4,
        // OpCopyObject, OpTranspose, OpSampledImage
        83 | 84 | 86 => all,
        // Sampling, fetching, reading and writing: a mask of image operands stands between ids.
        87 | 88 | 91 | 92 | 95 | 98 => return Some(at != 5),
        89 | 90 | 93 | 94 | 96 | 97 => return Some(at != 6),
        99 => return Some(at != 4),
        // OpImageTexelPointer, OpImage, queries
        60 | 100 | 103..=107 => all,
        op::COPY_LOGICAL => all,
        // Conversions, arithmetic, logic, bits, derivatives, barriers, atomics
        109..=124 | 126..=152 | 154..=191 | 194..=205 | 207..=215 | 224 | 225 | 227..=242 | op::PHI => all,
        op::LOOP_MERGE => 2,
        op::SELECTION_MERGE => 1,
        op::LABEL | op::BRANCH | op::RETURN_VALUE | op::KILL | op::RETURN | op::UNREACHABLE => all,
        op::TERMINATE_INVOCATION | op::DEMOTE_TO_HELPER_INVOCATION => all,
        op::BRANCH_CONDITIONAL => 3,
        // The selector, the default, then pairs of a literal and a label
        op::SWITCH => return Some(at <= 2 || at.is_multiple_of(2)),
        _ => return None,
    };
    Some(at <= leading)
}

/// A literal string.
pub(super) fn text(words: &[u32]) -> String {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).take_while(|byte| *byte != 0).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}
