//! The sizes of the blocks of ASTC textures.

/// Width and height in texels, in the order in which Vulkan, and with it KTX2, numbers the formats.
pub const BLOCKS: [(u8, u8); 14] = [
    (4, 4),
    (5, 4),
    (5, 5),
    (6, 5),
    (6, 6),
    (8, 5),
    (8, 6),
    (8, 8),
    (10, 5),
    (10, 6),
    (10, 8),
    (10, 10),
    (12, 10),
    (12, 12),
];
