//! The specialization constants that Rust sets.

/// A specialization constant that Rust sets.
#[derive(Clone, Copy, Debug)]
pub struct Specialization {
    /// `constant_id`.
    pub id: u32,
    /// Name in GLSL.
    pub name: &'static str,
    /// Its meaning.
    pub doc: &'static str,
}

/// `constant_id` of the debug mode.
pub const SPEC_MODE: u32 = 0;
/// Value of [`SPEC_MODE`] for the final picture. The shader tree defines all other modes.
pub const MODE_FINAL: u32 = 0;
/// `constant_id` of the material's alpha mode: [`ALPHA_OPAQUE`](super::ALPHA_OPAQUE), [`ALPHA_MASK`](super::ALPHA_MASK) or [`ALPHA_BLEND`](super::ALPHA_BLEND).
pub const SPEC_ALPHA_MODE: u32 = 1;
/// `constant_id` of the material's features: the `FEATURE_*` bits.
pub const SPEC_FEATURES: u32 = 2;

/// `constant_id` of the tone map, `TONEMAP_*` in common/tonemap.glsl or [`TONEMAP_OFF`](super::TONEMAP_OFF); for the tone mapping pass.
pub const SPEC_TONEMAP: u32 = 3;
/// `constant_id` of the encoding, `ENCODE_*`; for the tone mapping pass.
pub const SPEC_ENCODE: u32 = 4;

/// `constant_id` of the number of lights, up to [`UNROLLED_LIGHTS`]. 0 means that `Frame::light_count` has the number.
pub const SPEC_LIGHT_COUNT: u32 = 5;
/// Up to this many lights, a pipeline is specialized for their number, so that the loop over them is unrolled.
pub const UNROLLED_LIGHTS: usize = 4;

/// `constant_id` of whether the display maps values by range, channels or colormap; for the tone mapping pass.
pub const SPEC_MAPS_VALUES: u32 = 6;

/// `constant_id` of the number of suns of the environment, up to [`MAX_SUNS`](super::MAX_SUNS).
pub const SPEC_SUN_COUNT: u32 = 7;

/// `constant_id` of the samples of a pixel; for the passes that read single samples.
pub const SPEC_SAMPLES: u32 = 8;

/// `constant_id` of whether there are more than [`FEW_LIGHTS`](super::FEW_LIGHTS) lights, so that shaders look for them in the grid.
pub const SPEC_MANY_LIGHTS: u32 = 9;

/// The specialization constants that Rust sets for every stage; those from [`USER_CONSTANTS`](super::USER_CONSTANTS) on are the author's.
pub const SPECIALIZATION: &[Specialization] = &[
    Specialization { id: SPEC_MODE, name: "MODE", doc: "debug mode, one of MODE_* in debug/modes.glsl" },
    Specialization { id: SPEC_ALPHA_MODE, name: "ALPHA_MODE", doc: "glTF alphaMode, one of ALPHA_*" },
    Specialization { id: SPEC_FEATURES, name: "FEATURES", doc: "what the material uses, FEATURE_* bits" },
    Specialization { id: SPEC_TONEMAP, name: "TONEMAP", doc: "tone map, one of TONEMAP_* in common/tonemap.glsl" },
    Specialization { id: SPEC_ENCODE, name: "ENCODE", doc: "how the picture stores values, one of ENCODE_*" },
    Specialization {
        id: SPEC_LIGHT_COUNT,
        name: "LIGHT_COUNT",
        doc: "lights, if they are few; 0: see frame.light_count",
    },
    Specialization {
        id: SPEC_MAPS_VALUES,
        name: "MAPS_VALUES",
        doc: "not 0: the display maps values by range, channels or colormap",
    },
    Specialization {
        id: SPEC_SUN_COUNT,
        name: "SUN_COUNT",
        doc: "suns of the environment, which its irradiance and specular levels leave out",
    },
    Specialization {
        id: SPEC_SAMPLES,
        name: "SAMPLES",
        doc: "samples of a pixel; for the passes with to=resolve and to=peel",
    },
    Specialization {
        id: SPEC_MANY_LIGHTS,
        name: "MANY_LIGHTS",
        doc: "not 0: more than FEW_LIGHTS lights; see lighting/light_grid.glsl",
    },
];
