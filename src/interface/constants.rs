//! The numbers that Rust writes and GLSL compares with: each is a Rust constant and a `const uint` of the same name in GLSL.

macro_rules! constants {
    ($(#[doc = $doc:literal] $name:ident = $value:expr;)+) => {
        $(#[doc = $doc] pub const $name: u32 = $value;)+

        /// Name and value of every constant in this file.
        pub const UINTS: &[(&str, u32)] = &[$((stringify!($name), $name),)+];
    };
}

constants! {
    /// The mode in which `debug.frag` draws the edges of triangles over the picture.
    EDGES_MODE = (1 << 30) - 1;
    /// Modes from here on show the image of a declared pass.
    PASS_MODES = 1 << 30;

    /// glTF `alphaMode` OPAQUE.
    ALPHA_OPAQUE = 0;
    /// glTF `alphaMode` MASK.
    ALPHA_MASK = 1;
    /// glTF `alphaMode` BLEND.
    ALPHA_BLEND = 2;

    /// Drawn without lighting: KHR_materials_unlit, and points and lines without normals (glTF 2.0, section 3.9).
    FEATURE_UNLIT = 1;
    /// The material has a normal texture, and the mesh has a tangent frame for it.
    FEATURE_NORMAL_TEXTURE = 1 << 1;
    /// KHR_materials_clearcoat.
    FEATURE_CLEARCOAT = 1 << 2;
    /// The clear coat has a normal texture of its own.
    FEATURE_CLEARCOAT_NORMAL = 1 << 3;
    /// KHR_materials_anisotropy.
    FEATURE_ANISOTROPY = 1 << 4;
    /// KHR_materials_sheen.
    FEATURE_SHEEN = 1 << 5;
    /// KHR_materials_specular.
    FEATURE_SPECULAR = 1 << 6;
    /// KHR_materials_iridescence.
    FEATURE_IRIDESCENCE = 1 << 7;
    /// KHR_materials_transmission.
    FEATURE_TRANSMISSION = 1 << 8;
    /// KHR_materials_volume.
    FEATURE_VOLUME = 1 << 9;
    /// KHR_materials_dispersion.
    FEATURE_DISPERSION = 1 << 10;
    /// KHR_materials_diffuse_transmission.
    FEATURE_DIFFUSE_TRANSMISSION = 1 << 11;
    /// KHR_materials_pbrSpecularGlossiness: diffuse color, F0 and glossiness replace metallic-roughness.
    FEATURE_SPECULAR_GLOSSINESS = 1 << 12;
    /// The model gives the metal's complex index of refraction.
    FEATURE_CONDUCTOR = 1 << 13;
    /// Occlusion is the red channel of the metallic-roughness texture, so one read serves both.
    FEATURE_PACKED_OCCLUSION = 1 << 14;
    /// Image-based light replaces `Frame::ambient`. The same for all materials of a frame.
    FEATURE_ENVIRONMENT = 1 << 15;
    /// There are rectangular lights. The same for all materials of a frame.
    FEATURE_RECT_LIGHTS = 1 << 16;
    /// Some texture is read at TEXCOORD_1, or moved by KHR_texture_transform.
    FEATURE_TEXTURE_COORDINATES = 1 << 17;
    /// The mesh has TEXCOORD_1.
    FEATURE_UV1 = 1 << 18;
    /// The mesh has COLOR_0, and the material does not replace it.
    FEATURE_VERTEX_COLOR = 1 << 19;

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

/// Number of the highest `FEATURE_*` bit. All bits below it are features.
pub const LAST_FEATURE: u32 = FEATURE_VERTEX_COLOR.ilog2();
