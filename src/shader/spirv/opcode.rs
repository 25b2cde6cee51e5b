//! Opcodes of the SPIR-V instructions that Specula reads (SPIR-V specification, section 3.52).

pub const NAME: u32 = 5;
pub const MEMBER_NAME: u32 = 6;
pub const ENTRY_POINT: u32 = 15;
pub const CAPABILITY: u32 = 17;
pub const TYPE_BOOL: u32 = 20;
pub const TYPE_INT: u32 = 21;
pub const TYPE_FLOAT: u32 = 22;
pub const TYPE_VECTOR: u32 = 23;
pub const TYPE_MATRIX: u32 = 24;
pub const TYPE_IMAGE: u32 = 25;
pub const TYPE_SAMPLER: u32 = 26;
pub const TYPE_SAMPLED_IMAGE: u32 = 27;
pub const TYPE_ARRAY: u32 = 28;
pub const TYPE_RUNTIME_ARRAY: u32 = 29;
pub const TYPE_STRUCT: u32 = 30;
pub const TYPE_POINTER: u32 = 32;
pub const CONSTANT_TRUE: u32 = 41;
pub const CONSTANT_FALSE: u32 = 42;
pub const CONSTANT: u32 = 43;
pub const SPEC_CONSTANT_TRUE: u32 = 48;
pub const SPEC_CONSTANT_FALSE: u32 = 49;
pub const SPEC_CONSTANT: u32 = 50;
pub const SPEC_CONSTANT_OP: u32 = 52;
pub const FUNCTION: u32 = 54;
pub const FUNCTION_END: u32 = 56;
pub const FUNCTION_CALL: u32 = 57;
pub const VARIABLE: u32 = 59;
pub const DECORATE: u32 = 71;
pub const MEMBER_DECORATE: u32 = 72;
pub const PHI: u32 = 245;
pub const LOOP_MERGE: u32 = 246;
pub const SELECTION_MERGE: u32 = 247;
pub const LABEL: u32 = 248;
pub const BRANCH: u32 = 249;
pub const BRANCH_CONDITIONAL: u32 = 250;
pub const SWITCH: u32 = 251;
pub const RETURN_VALUE: u32 = 254;
pub const UNREACHABLE: u32 = 255;

/// Opcodes within functions that have no result id: stores, merges, branches, barriers.
pub const WITHOUT_RESULT: [u32; 17] = [0, 8, 62, 63, 99, 224, 225, 228, 246, 247, 249, 250, 251, 252, 253, 317, 4416];
