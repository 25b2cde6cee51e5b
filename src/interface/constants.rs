//! The numbers that Rust writes and GLSL compares with: each is a Rust constant and a `const uint` of the same name in GLSL.

/// Declares constants, and a table with the name and value of each.
macro_rules! constants {
    ($(#[doc = $table_doc:literal])+ $table:ident: $(#[doc = $doc:literal] $name:ident = $value:expr;)+) => {
        $(#[doc = $doc] pub const $name: u32 = $value;)+

        $(#[doc = $table_doc])+
        pub const $table: &[(&str, u32)] = &[$((stringify!($name), $name),)+];
    };
}

pub(super) use constants;

constants! {
    /// Modes that no shader tree declares.
    MODE_CONSTANTS:

    /// The mode in which `debug.frag` draws the edges of triangles over the picture.
    EDGES_MODE = (1 << 30) - 1;
    /// Modes from here on show the image of a declared pass.
    PASS_MODES = 1 << 30;
}

constants! {
    /// All other constants.
    OTHER_CONSTANTS:

    /// `Draw::attributes`: the file has normals; else flat ones are generated.
    ATTRIBUTE_NORMAL = 1;
    /// `Draw::attributes`: the file has tangents; else MikkTSpace generates them.
    ATTRIBUTE_TANGENT = 1 << 1;
    /// `Draw::attributes`: the mesh has TEXCOORD_0.
    ATTRIBUTE_UV0 = 1 << 2;
    /// `Draw::attributes`: the mesh has TEXCOORD_1.
    ATTRIBUTE_UV1 = 1 << 3;
    /// `Draw::attributes`: the mesh has COLOR_0.
    ATTRIBUTE_COLOR = 1 << 4;
    /// `Draw::attributes`: the mesh has a usable tangent frame, from the file or generated.
    ATTRIBUTE_TANGENT_FRAME = 1 << 5;
    /// `Draw::attributes`: the draw was elsewhere in the frame before, or its vertices were.
    ATTRIBUTE_MOVED = 1 << 6;

    /// `Light::kind`: parallel light, intensity in lux.
    LIGHT_DIRECTIONAL = 0;
    /// `Light::kind`: point light, intensity in candela.
    LIGHT_POINT = 1;
    /// `Light::kind`: spot light, intensity in candela.
    LIGHT_SPOT = 2;
    /// `Light::kind`: one-sided rectangle, intensity in cd/m^2.
    LIGHT_RECT = 3;

    /// First word of the measured BRDF's buffer: no measured BRDF.
    MEASURED_NONE = 0;
    /// First word of the measured BRDF's buffer: MERL's grid follows.
    MEASURED_MERL = 1;
    /// First word of the measured BRDF's buffer: UTIA's grid follows.
    MEASURED_UTIA = 2;

    /// `SPEC_ENCODE`: colors, sRGB-encoded on output.
    ENCODE_COLOR = 0;
    /// `SPEC_ENCODE`: numbers, stored as they are.
    ENCODE_DATA = 1;
    /// `SPEC_ENCODE`: vectors, stored as v * 0.5 + 0.5.
    ENCODE_VECTOR = 2;

    /// Added to the HDR target's alpha: the debug mode has no data there. `PixelValue::decode` reads it.
    FLAG_NO_DATA = 16;
    /// Added to the HDR target's alpha: the value is NaN or infinite.
    FLAG_NOT_FINITE = 256;

    /// Levels of the deepest bounding volume hierarchy.
    MAX_BVH_DEPTH = 64;
    /// `TracedMaterial::layers`: there is no texture.
    NO_TEXTURE = u32::MAX;

    /// Side of the octahedral map of irradiance in texels, with its border. Irradiance varies as slowly as the cosine.
    IRRADIANCE_SIDE = 68;
    /// The last level of prefiltered radiance, roughness 1 (ibl/maps/levels.glsl).
    SPECULAR_LEVELS = 16;
    /// Side of level 0, a mirror, in texels, with its border.
    MIRROR_SIDE = 640;
    /// Side of level 1, half of it.
    SPECULAR_SIDE = 320;
    /// Width of the image that holds all levels. Rows of a multiple of 512 bytes would share few sets of a cache.
    SPECULAR_WIDTH = 648;
    /// Height of the image that holds all levels.
    SPECULAR_HEIGHT = 1792;

    /// `SPEC_TONEMAP`: debug modes whose values are not light skip exposure and tone mapping.
    TONEMAP_OFF = u32::MAX;
}
