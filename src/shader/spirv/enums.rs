//! Numbers of the specification's enumerations (section 3) that more than one file reads.

/// Decorations.
pub mod decoration {
    pub const SPEC_ID: u32 = 1;
    pub const BLOCK: u32 = 2;
    pub const BUFFER_BLOCK: u32 = 3;
    pub const ARRAY_STRIDE: u32 = 6;
    pub const MATRIX_STRIDE: u32 = 7;
    pub const BUILT_IN: u32 = 11;
    pub const FLAT: u32 = 14;
    pub const PATCH: u32 = 15;
    pub const VOLATILE: u32 = 21;
    pub const COHERENT: u32 = 23;
    pub const NON_WRITABLE: u32 = 24;
    pub const LOCATION: u32 = 30;
    pub const BINDING: u32 = 33;
    pub const DESCRIPTOR_SET: u32 = 34;
    pub const OFFSET: u32 = 35;
    pub const PER_PRIMITIVE: u32 = 5271;
}

/// Built-in variables.
pub mod built_in {
    pub const PRIMITIVE_ID: u32 = 7;
    pub const SAMPLE_ID: u32 = 18;
    pub const SAMPLE_POSITION: u32 = 19;
    pub const SAMPLE_MASK: u32 = 20;
    pub const WORKGROUP_SIZE: u32 = 25;
    pub const INSTANCE_INDEX: u32 = 43;
    pub const BASE_INSTANCE: u32 = 4425;
}

/// Storage classes.
pub mod storage {
    pub const UNIFORM_CONSTANT: u32 = 0;
    pub const INPUT: u32 = 1;
    pub const UNIFORM: u32 = 2;
    pub const OUTPUT: u32 = 3;
    pub const PRIVATE: u32 = 6;
    pub const FUNCTION: u32 = 7;
    pub const PUSH_CONSTANT: u32 = 9;
    pub const STORAGE_BUFFER: u32 = 12;
    pub const PHYSICAL_STORAGE_BUFFER: u32 = 5349;
    pub const TASK_PAYLOAD: u32 = 5402;
}

/// Execution models.
pub mod model {
    pub const VERTEX: u32 = 0;
    pub const CONTROL: u32 = 1;
    pub const EVALUATION: u32 = 2;
    pub const GEOMETRY: u32 = 3;
    pub const FRAGMENT: u32 = 4;
    pub const MESH: u32 = 5365;
}

/// Instructions of GLSL.std.450.
pub mod extended {
    pub const FABS: u32 = 4;
    pub const ASIN: u32 = 16;
    pub const ACOS: u32 = 17;
    pub const ACOSH: u32 = 23;
    pub const ATANH: u32 = 24;
    pub const ATAN2: u32 = 25;
    pub const POW: u32 = 26;
    pub const LOG: u32 = 28;
    pub const LOG2: u32 = 30;
    pub const SQRT: u32 = 31;
    pub const INVERSE_SQRT: u32 = 32;
    pub const DETERMINANT: u32 = 33;
    pub const MATRIX_INVERSE: u32 = 34;
    pub const MODF: u32 = 35;
    pub const UMIN: u32 = 38;
    pub const SMIN: u32 = 39;
    pub const FCLAMP: u32 = 43;
    pub const UCLAMP: u32 = 44;
    pub const SCLAMP: u32 = 45;
    pub const SMOOTHSTEP: u32 = 49;
    pub const FREXP: u32 = 51;
    pub const NORMALIZE: u32 = 69;
    pub const INTERPOLATE_AT_CENTROID: u32 = 76;
    pub const INTERPOLATE_AT_OFFSET: u32 = 78;
}
