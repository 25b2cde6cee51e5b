// The debug modes. Each is one value of the specialization constant MODE, so a pipeline holds the code of one only.
//
// To add one: an annotation and a constant here, its value in `your_mode` at the end of this file, save.
//
//   @mode SLUG "Name" group="Group" encode=color|data|vector [components=1|2|3] [unit="m"] [tonemap] [accumulate]
//         [through] [draw=lines|layers] [key=d] doc=""
//   const uint MODE_NAME = 1000u;
//
// The first line in a comment that starts with the at sign; any number that no other mode has.
//
//   encode    how a PNG and the window store the value: color: sRGB curve; data: as it is; vector: v * 0.5 + 0.5
//   components  how many numbers a value has: 1 for a scalar, which the shader repeats in all channels; 3 unless given
//   unit      of the value as the shader returns it, before exposure: m, 1/sr, cd/m^2
//   draw      lines: the edges of triangles; layers: every fragment added up, hidden ones too
//   tonemap   the value is light: exposure and tone map apply
//   accumulate  the value is an estimate by frame.sample_count random paths a pixel, others in each frame
//             (frame.sample_index counts them): the renderer shows the mean over the frames since the picture changed
//   through   what is seen through glass is the picture, not this mode of it
//   key       a letter that shows the mode in the window
//
// Values are raw: a depth is in meters, D exceeds 1. A checkerboard means that the model or the light has no such data.
#ifndef DEBUG_MODES_GLSL
#define DEBUG_MODES_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "common/fragment.glsl"

//@mode final "Final" group="Picture" encode=color unit="cd/m^2" tonemap key=p doc="All lights, the environment and emission."
const uint MODE_FINAL = 0u;
//@mode clay "Clay" group="Picture" encode=color unit="cd/m^2" tonemap key=c doc="Matte gray of albedo 0.5 with the model's normals."
const uint MODE_CLAY = 1u;

//@mode position "Position" group="Geometry" encode=data unit="m" doc="World space, meters."
const uint MODE_POSITION = 200u;
//@mode depth "Depth" group="Geometry" encode=data components=1 unit="m" key=z doc="Distance from the eye along the view direction, meters."
const uint MODE_DEPTH = 201u;
//@mode geometric-normal "Geometric normal" group="Geometry" encode=vector doc="The mesh's normal, world space."
const uint MODE_GEOMETRIC_NORMAL = 202u;
//@mode shading-normal "Shading normal" group="Geometry" encode=vector key=n doc="The normal that is lit, world space."
const uint MODE_SHADING_NORMAL = 203u;
//@mode facet-normal "Facet normal" group="Geometry" encode=vector doc="The triangle's own normal, world space."
const uint MODE_FACET_NORMAL = 204u;
//@mode tangent "Tangent" group="Geometry" encode=vector key=t doc="The mesh's tangent, world space."
const uint MODE_TANGENT = 205u;
//@mode bitangent "Bitangent" group="Geometry" encode=vector doc="cross(normal, tangent) times the sign, world space."
const uint MODE_BITANGENT = 206u;
//@mode tangent-sign "Tangent sign" group="Geometry" encode=color doc="Green is +1, red is -1: mirrored UVs."
const uint MODE_TANGENT_SIGN = 207u;
//@mode uv0 "UV 0" group="Geometry" encode=data components=2 doc="TEXCOORD_0."
const uint MODE_UV0 = 208u;
//@mode uv1 "UV 1" group="Geometry" encode=data components=2 doc="TEXCOORD_1."
const uint MODE_UV1 = 209u;
//@mode vertex-color "Vertex color" group="Geometry" encode=color doc="COLOR_0, linear RGB."
const uint MODE_VERTEX_COLOR = 210u;
//@mode face-orientation "Face orientation" group="Geometry" encode=color doc="Green is the front, red the back."
const uint MODE_FACE_ORIENTATION = 211u;
//@mode triangle-id "Triangle" group="Geometry" encode=color doc="A color for each triangle of a mesh."
const uint MODE_TRIANGLE_ID = 212u;
//@mode mesh-id "Mesh" group="Geometry" encode=color doc="A color for each primitive."
const uint MODE_MESH_ID = 213u;
//@mode node-id "Node" group="Geometry" encode=color doc="A color for each node of the scene."
const uint MODE_NODE_ID = 214u;
//@mode material-id "Material" group="Geometry" encode=color doc="A color for each material."
const uint MODE_MATERIAL_ID = 215u;
//@mode mip-level "Mip level" group="Geometry" encode=color doc="Base color texture: blue is level 0, red 8 and up."
const uint MODE_MIP_LEVEL = 216u;
//@mode texel-density "Texel density" group="Geometry" encode=color doc="Base color: blue 16 texels a meter, red 16384."
const uint MODE_TEXEL_DENSITY = 217u;
//@mode wireframe "Wireframe" group="Geometry" encode=color draw=lines key=w doc="The edges of the triangles."
const uint MODE_WIREFRAME = 218u;
//@mode overdraw "Overdraw" group="Geometry" encode=color draw=layers doc="Each fragment drawn at a pixel adds 0.1, hidden ones too."
const uint MODE_OVERDRAW = 219u;

//@mode base-color "Base color" group="Material" encode=color key=b doc="Texture, factor and vertex color, linear RGB."
const uint MODE_BASE_COLOR = 100u;
//@mode alpha "Alpha" group="Material" encode=data components=1 doc="Coverage before the cutoff; 1 where the material is opaque."
const uint MODE_ALPHA = 101u;
//@mode metallic "Metallic" group="Material" encode=data components=1 key=m doc="0 is a dielectric, 1 a metal."
const uint MODE_METALLIC = 102u;
//@mode roughness "Roughness" group="Material" encode=data components=1 key=u doc="Perceptual roughness."
const uint MODE_ROUGHNESS = 103u;
//@mode ggx-alpha "GGX alpha" group="Material" encode=data components=1 doc="Width of the lobe: roughness^2, at least 0.0025."
const uint MODE_GGX_ALPHA = 104u;
//@mode occlusion "Occlusion" group="Material" encode=data components=1 doc="1 sees the whole sky; dims only the environment."
const uint MODE_OCCLUSION = 105u;
//@mode emissive "Emissive" group="Material" encode=color unit="cd/m^2" doc="Texture and factor, linear RGB, without exposure."
const uint MODE_EMISSIVE = 106u;
//@mode normal-texture "Normal texture" group="Material" encode=vector doc="Tangent space, scaled, unit length."
const uint MODE_NORMAL_TEXTURE = 107u;
//@mode diffuse-color "Diffuse color" group="Material" encode=color doc="base color (1 - metallic)."
const uint MODE_DIFFUSE_COLOR = 108u;
//@mode f0 "F0" group="Material" encode=color doc="Reflectance along the normal, dielectric and metal mixed."
const uint MODE_F0 = 109u;
//@mode f90 "F90" group="Material" encode=color components=1 doc="Reflectance at a grazing angle: 1, or the specular factor."
const uint MODE_F90 = 110u;
//@mode ior "Index of refraction" group="Material" encode=data components=1 doc="Of the dielectric: 1.5 unless the model says more."
const uint MODE_IOR = 111u;
//@mode clearcoat "Clearcoat" group="Material" encode=data components=1 doc="0 bare .. 1 coated."
const uint MODE_CLEARCOAT = 112u;
//@mode clearcoat-roughness "Clearcoat roughness" group="Material" encode=data components=1 doc="Perceptual roughness of the coat."
const uint MODE_CLEARCOAT_ROUGHNESS = 113u;
//@mode clearcoat-normal "Clearcoat normal" group="Material" encode=vector doc="The coat's own normal, world space."
const uint MODE_CLEARCOAT_NORMAL = 114u;
//@mode anisotropy "Anisotropy" group="Material" encode=data components=1 doc="0 a round highlight .. 1 the longest."
const uint MODE_ANISOTROPY = 115u;
//@mode anisotropy-direction "Anisotropy axis" group="Material" encode=vector doc="Where the lobe is long, world space."
const uint MODE_ANISOTROPY_DIRECTION = 116u;
//@mode sheen-color "Sheen color" group="Material" encode=color doc="Of the fibers, linear RGB; black has no sheen."
const uint MODE_SHEEN_COLOR = 117u;
//@mode sheen-roughness "Sheen roughness" group="Material" encode=data components=1 doc="How much the fibers stray from the normal."
const uint MODE_SHEEN_ROUGHNESS = 118u;
//@mode specular-factor "Specular factor" group="Material" encode=data components=1 doc="F90 of the dielectric."
const uint MODE_SPECULAR_FACTOR = 119u;
//@mode specular-color "Specular color" group="Material" encode=color doc="F0 of the dielectric: color, factor and ior."
const uint MODE_SPECULAR_COLOR = 120u;
//@mode iridescence "Iridescence" group="Material" encode=data components=1 doc="0 no film .. 1."
const uint MODE_IRIDESCENCE = 121u;
//@mode iridescence-thickness "Iridescence thickness" group="Material" encode=data components=1 unit="um" doc="Of the film, micrometers."
const uint MODE_IRIDESCENCE_THICKNESS = 122u;
//@mode transmission "Transmission" group="Material" encode=data components=1 doc="Part of what enters that goes straight through."
const uint MODE_TRANSMISSION = 123u;
//@mode thickness "Thickness" group="Material" encode=data components=1 unit="m" doc="Of the volume behind the surface, world space, meters."
const uint MODE_THICKNESS = 124u;
//@mode attenuation-color "Attenuation color" group="Material" encode=color doc="What is left of white at a distance."
const uint MODE_ATTENUATION_COLOR = 125u;
//@mode dispersion "Dispersion" group="Material" encode=data components=1 doc="20 / Abbe number."
const uint MODE_DISPERSION = 126u;
//@mode diffuse-transmission "Diffuse transmission" group="Material" encode=data components=1 doc="Diffuse light: the part passing."
const uint MODE_DIFFUSE_TRANSMISSION = 127u;
//@mode diffuse-transmission-color "Diffuse transmission tint" group="Material" encode=color doc="Albedo, light behind."
const uint MODE_DIFFUSE_TRANSMISSION_COLOR = 128u;

// D to V dot H: of the chosen light, or of light 1 when all are chosen.
//@mode d "Normal distribution D" group="BRDF terms" encode=data components=1 unit="1/sr" key=d doc="GGX (Walter et al. 2007, eq. 33), 1/sr."
const uint MODE_D = 300u;
//@mode g "Masking-shadowing G" group="BRDF terms" encode=data components=1 key=g doc="Smith, GGX (Heitz 2014, eq. 98 or 99)."
const uint MODE_G = 301u;
//@mode v "Visibility V" group="BRDF terms" encode=data components=1 key=v doc="G / (4 NoL NoV)."
const uint MODE_V = 302u;
//@mode f "Fresnel F" group="BRDF terms" encode=color key=f doc="Dielectric and metal mixed (Schlick 1994, eq. 15)."
const uint MODE_F = 303u;
//@mode k-d "Diffuse weight k_d" group="BRDF terms" encode=data components=1 doc="(1 - metallic) (1 - F of the dielectric)."
const uint MODE_K_D = 304u;
//@mode k-s "Specular weight k_s" group="BRDF terms" encode=color doc="mix(F dielectric, F metal, metallic): F itself."
const uint MODE_K_S = 305u;
//@mode n-dot-l "N dot L" group="BRDF terms" encode=data components=1 doc="0 behind the surface."
const uint MODE_N_DOT_L = 306u;
//@mode n-dot-v "N dot V" group="BRDF terms" encode=data components=1 doc="At least 0.0001. Needs no light."
const uint MODE_N_DOT_V = 307u;
//@mode n-dot-h "N dot H" group="BRDF terms" encode=data components=1 doc="h lies halfway between l and v."
const uint MODE_N_DOT_H = 308u;
//@mode v-dot-h "V dot H" group="BRDF terms" encode=data components=1 doc="Equal to L dot H: the angle that Fresnel takes."
const uint MODE_V_DOT_H = 309u;
// Of the chosen light, or the sum over all.
//@mode diffuse-lobe "Diffuse lobe" group="BRDF terms" encode=color unit="1/sr" doc="k_d albedo / pi, 1/sr (Lambert 1760)."
const uint MODE_DIFFUSE_LOBE = 310u;
//@mode specular-lobe "Specular lobe" group="BRDF terms" encode=color unit="1/sr" key=k doc="k_s D V, 1/sr (Cook & Torrance 1982)."
const uint MODE_SPECULAR_LOBE = 311u;
//@mode multi-scatter-lobe "Multi-scatter lobe" group="BRDF terms" encode=color unit="1/sr" doc="Reflected twice and more, 1/sr."
const uint MODE_MULTI_SCATTER_LOBE = 312u;
//@mode clearcoat-lobe "Clearcoat lobe" group="BRDF terms" encode=color unit="1/sr" doc="D V of the coat by its weight, 1/sr."
const uint MODE_CLEARCOAT_LOBE = 313u;
//@mode sheen-lobe "Sheen lobe" group="BRDF terms" encode=color unit="1/sr" doc="sheen color D V, 1/sr (Estevez & Kulla 2017)."
const uint MODE_SHEEN_LOBE = 314u;

// Of the chosen light, of all lights when all are chosen; from `ambient` to `luminance`, chosen or not.
//@mode dielectric "Dielectric only" group="Light" encode=color unit="cd/m^2" tonemap key=i doc="The picture with metallic 0."
const uint MODE_DIELECTRIC = 400u;
//@mode metal "Metal only" group="Light" encode=color unit="cd/m^2" tonemap key=j doc="The picture with metallic 1."
const uint MODE_METAL = 401u;
//@mode direct-diffuse "Direct diffuse" group="Light" encode=color unit="cd/m^2" tonemap doc="Diffuse lobe, all lights or one."
const uint MODE_DIRECT_DIFFUSE = 402u;
//@mode direct-specular "Direct specular" group="Light" encode=color unit="cd/m^2" tonemap doc="Specular lobe, all lights or one."
const uint MODE_DIRECT_SPECULAR = 403u;
//@mode lambert "Lambert, no cosine" group="Light" encode=color unit="cd/m^2" tonemap doc="base color / pi times irradiance."
const uint MODE_LAMBERT = 404u;
//@mode ambient "Ambient" group="Light" encode=color unit="cd/m^2" tonemap doc="All light of the environment, or flat ambient light."
const uint MODE_AMBIENT = 405u;
//@mode emissive-only "Emission" group="Light" encode=color unit="cd/m^2" tonemap doc="Emission alone, exposed like the picture."
const uint MODE_EMISSIVE_ONLY = 406u;
//@mode light-1 "Light 1" group="Light" encode=color unit="cd/m^2" tonemap doc="The first light alone, with ambient light."
const uint MODE_LIGHT_1 = 407u;
//@mode light-2 "Light 2" group="Light" encode=color unit="cd/m^2" tonemap doc="The second light alone, with ambient light."
const uint MODE_LIGHT_2 = 408u;
//@mode light-3 "Light 3" group="Light" encode=color unit="cd/m^2" tonemap doc="The third light alone, with ambient light."
const uint MODE_LIGHT_3 = 409u;
//@mode luminance "Luminance" group="Light" encode=color components=1 unit="cd/m^2" tonemap doc="Y of the picture (ITU-R BT.709)."
const uint MODE_LUMINANCE = 410u;
// The environment.
//@mode ibl-diffuse "Environment, diffuse" group="Light" encode=color unit="cd/m^2" tonemap doc="Irradiance times the diffuse albedo."
const uint MODE_IBL_DIFFUSE = 411u;
//@mode ibl-specular "Environment, specular" group="Light" encode=color unit="cd/m^2" tonemap doc="Split sum, one bounce: Karis 2013."
const uint MODE_IBL_SPECULAR = 412u;
//@mode irradiance "Irradiance" group="Light" encode=color unit="lux" tonemap doc="Of the environment on the normal's side, lux."
const uint MODE_IRRADIANCE = 413u;
//@mode prefiltered "Prefiltered radiance" group="Light" encode=color unit="cd/m^2" tonemap doc="Mirrored environment, blurred."
const uint MODE_PREFILTERED = 414u;
//@mode dfg "DFG terms" group="Light" encode=data doc="A, B, C: albedo of the lobe is F0 A + F90 B - beta C."
const uint MODE_DFG = 415u;
// Of the chosen light or of all, and of the environment.
//@mode clearcoat-light "Clearcoat light" group="Light" encode=color unit="cd/m^2" tonemap doc="What the coat reflects."
const uint MODE_CLEARCOAT_LIGHT = 416u;
//@mode sheen-light "Sheen light" group="Light" encode=color unit="cd/m^2" tonemap doc="What the fibers scatter."
const uint MODE_SHEEN_LIGHT = 417u;
//@mode transmitted-light "Transmitted light" group="Light" encode=color unit="cd/m^2" tonemap through doc="What passes through the surface."
const uint MODE_TRANSMITTED_LIGHT = 418u;
//@mode multiple-scattering "Multiple scattering" group="Light" encode=color unit="cd/m^2" tonemap doc="Off two microfacets or more."
const uint MODE_MULTIPLE_SCATTERING = 419u;
//@mode area-light "Area lights" group="Light" encode=color unit="cd/m^2" tonemap doc="Rectangles only (Heitz et al. 2016)."
const uint MODE_AREA_LIGHT = 420u;
// Of all lights, chosen or not.
//@mode single-scattering "Single scattering" group="Light" encode=color unit="cd/m^2" tonemap doc="The picture without the above."
const uint MODE_SINGLE_SCATTERING = 421u;
//@mode environment "Environment" group="Light" encode=color unit="cd/m^2" tonemap doc="Mirrored without blur: a chrome model."
const uint MODE_ENVIRONMENT = 422u;

// By the chosen light or all that have no size: no environment, no emission.
//@mode measured "Measured" group="Measured" encode=color unit="cd/m^2" tonemap doc="With the measured BRDF instead of the material."
const uint MODE_MEASURED = 600u;
//@mode measured-split "Split" group="Measured" encode=color unit="cd/m^2" tonemap doc="Left measured, right as shaded."
const uint MODE_MEASURED_SPLIT = 601u;
//@mode measured-error "Error" group="Measured" encode=color doc="Blue too dark, green equal, red too bright."
const uint MODE_MEASURED_ERROR = 602u;

//@mode nan "NaN, Inf, negative" group="Truth" encode=color key=x doc="NaN magenta, Inf yellow, negative cyan."
const uint MODE_NAN = 500u;
//@mode negative "Negative" group="Truth" encode=color doc="Channels of the picture below zero; else dark."
const uint MODE_NEGATIVE = 501u;
//@mode clipped "Clipped" group="Truth" encode=color doc="Channels above 1 after exposure, before the tone map."
const uint MODE_CLIPPED = 502u;
//@mode false-color "False-color exposure" group="Truth" encode=color doc="Stops off middle gray: blue -6, red +6."
const uint MODE_FALSE_COLOR = 503u;
//@mode albedo-range "Albedo range" group="Truth" encode=color doc="sRGB under 30 blue, over 240 red (McDermott 2018)."
const uint MODE_ALBEDO_RANGE = 504u;
//@mode f0-range "F0 range" group="Truth" encode=color doc="Red: neither dielectric (to 5 %) nor metal (sRGB 180 up)."
const uint MODE_F0_RANGE = 505u;
//@mode monte-carlo "Monte Carlo" group="Truth" encode=color unit="cd/m^2" tonemap accumulate doc="The picture with random paths."
const uint MODE_MONTE_CARLO = 506u;
//@mode ibl-error "Split sum error" group="Truth" encode=vector unit="cd/m^2" accumulate doc="Monte Carlo minus split sum."
const uint MODE_IBL_ERROR = 507u;
//@mode energy "Energy" group="Truth" encode=data doc="Reflected part of white light from everywhere; red above 1.005."
const uint MODE_ENERGY = 508u;

// Yours: the value of a mode of your own, from the fragment, the surface as it is shaded and the direction to the eye.
//
//     if (MODE == MODE_HEIGHT) { value = vec3(f.position_ws.y); return true; }
bool your_mode(Fragment f, Surface s, vec3 v, out vec3 value) {
    return false;
}

#endif
