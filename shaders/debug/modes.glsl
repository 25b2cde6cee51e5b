// The debug modes. Each is a value of the specialization constant MODE, so a pipeline holds the code of a single mode.
//
// To add a mode, write an annotation and a constant here, compute its value in `your_mode` below, and save.
//
//   @mode SLUG "Name" group="Group" encode=color|data|vector [components=1|2|3] [unit="m"] [stage=debug]
//         [range=LOW..HIGH] [colormap=viridis|magma|turbo|coolwarm|heat] [numbers=index|"NAME|NAME"]
//         [colors="#rrggbb|-"]
//         [tonemap] [accumulate] [traces] [through] [draw=lines|layers] [needs=FEATURES] [key=d] doc=""
//   const uint MODE_NAME = 1000u;
//
// The first line is a comment that starts with the at sign. The number must be unique.
//
//   encode    how a PNG and the window store the value: color: sRGB curve; data: unchanged; vector: v * 0.5 + 0.5
//   components  components of a value, 3 by default; with 1, the shader repeats the scalar in all channels
//   unit      unit of the returned value, before exposure: m, 1/sr, cd/m^2
//   range     values that the picture shows as 0 and 1; without it those of `encode`. The window fits it to the picture where
//             values have a unit or leave 0..1 (view.range)
//   colormap  colors that stand for a number, in a mode with one component
//   numbers   the picture shows a color for each number (`number_or_color`). Where a single pixel is read, the shader returns the
//             number: an index (index), or a place in a list of names ("front|back": 0 is front, 1 is back)
//   colors    sRGB colors of these names, which the legend shows; - for a color that follows the picture
//   draw      lines: the edges of triangles; layers: the sum of all fragments, hidden or not
//   tonemap   the value is light, so exposure and tone map apply
//   accumulate  the value is an estimate from frame.sample_count paths per pixel; the renderer accumulates frames
//             of all frames since the picture changed, and frame.sample_index counts these frames
//   stage     the stage that computes the value: debug.frag (default), paths.frag, pbr.frag (the picture alone), or one of
//             your own, which says //@pass NAME draw=model to=picture instead=model
//   traces    rays can be traced through the model (paths/bvh.glsl), in paths.frag
//   through   transmissive surfaces show the final picture behind them instead of this mode
//   needs     features of materials or light without which there is nothing to see, as clearcoat or sheen,volume (FEATURE_* in
//             interface.glsl); the window folds such modes away for models that have none of them
//   key       letter key that selects the mode in the window
//
// Values are raw: depth is in meters, and D may exceed 1. A checkerboard means that the model or light lacks the data.
#ifndef DEBUG_MODES_GLSL
#define DEBUG_MODES_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "common/fragment.glsl"

//@mode final "Final" group="Picture" encode=color unit="cd/m^2" tonemap stage=pbr key=p doc="The final picture: all lights, environment and emission."
const uint MODE_FINAL = 0u;
//@mode clay "Clay" group="Picture" encode=color unit="cd/m^2" tonemap key=c words="white matte untextured" doc="Matte gray of albedo 0.5 with the model's normals."
const uint MODE_CLAY = 1u;

//@mode position "Position" group="Geometry" encode=data unit="m" doc="World-space position, meters."
const uint MODE_POSITION = 200u;
//@mode depth "Depth" group="Geometry" encode=data components=1 unit="m" key=z words="distance z" doc="Distance from the eye along the view direction, meters."
const uint MODE_DEPTH = 201u;
//@mode geometric-normal "Geometric normal" group="Geometry" encode=vector words="normals vertex" doc="The mesh's interpolated normal, world space."
const uint MODE_GEOMETRIC_NORMAL = 202u;
//@mode shading-normal "Shading normal" group="Geometry" encode=vector key=n words="normals bump" doc="The normal used for shading, world space."
const uint MODE_SHADING_NORMAL = 203u;
//@mode facet-normal "Facet normal" group="Geometry" encode=vector words="normals flat" doc="The triangle's normal, world space."
const uint MODE_FACET_NORMAL = 204u;
//@mode tangent "Tangent" group="Geometry" encode=vector key=t doc="The mesh's tangent, world space."
const uint MODE_TANGENT = 205u;
//@mode bitangent "Bitangent" group="Geometry" encode=vector doc="cross(normal, tangent) times the sign, world space."
const uint MODE_BITANGENT = 206u;
//@mode tangent-sign "Tangent sign" group="Geometry" encode=color numbers="-1|+1" colors="#e74530|#3fbc59" doc="Green +1, red -1 (mirrored UVs)."
const uint MODE_TANGENT_SIGN = 207u;
//@mode uv0 "UV 0" group="Geometry" encode=data components=2 range=0..1 words="texture coordinates" doc="TEXCOORD_0."
const uint MODE_UV0 = 208u;
//@mode uv1 "UV 1" group="Geometry" encode=data components=2 range=0..1 needs=uv1 words="texture coordinates" doc="TEXCOORD_1."
const uint MODE_UV1 = 209u;
//@mode vertex-color "Vertex color" group="Geometry" encode=color needs=vertex-color doc="COLOR_0, linear RGB."
const uint MODE_VERTEX_COLOR = 210u;
//@mode face-orientation "Face orientation" group="Geometry" encode=color numbers="front|back" colors="#3fbc59|#e74530" words="facing backface winding culling" doc="Green front faces, red back faces."
const uint MODE_FACE_ORIENTATION = 211u;
//@mode triangle-id "Triangle" group="Geometry" encode=color numbers=index doc="A color for each triangle of a mesh."
const uint MODE_TRIANGLE_ID = 212u;
//@mode mesh-id "Mesh" group="Geometry" encode=color numbers=index doc="A color for each primitive."
const uint MODE_MESH_ID = 213u;
//@mode node-id "Node" group="Geometry" encode=color numbers=index words="object" doc="A color for each node of the scene."
const uint MODE_NODE_ID = 214u;
//@mode material-id "Material" group="Geometry" encode=color numbers=index doc="A color for each material."
const uint MODE_MATERIAL_ID = 215u;
//@mode mip-level "Mip level" group="Geometry" encode=color components=1 unit="level" range=0..8 colormap=heat doc="Of the base color texture: blue level 0, red 8 and up."
const uint MODE_MIP_LEVEL = 216u;
//@mode texel-density "Texel density" group="Geometry" encode=color components=1 unit="log2 texels/m" range=4..14 colormap=heat words="resolution" doc="Base color texels per meter, as a power of 2: blue 16, red 16384."
const uint MODE_TEXEL_DENSITY = 217u;
//@mode wireframe "Wireframe" group="Geometry" encode=color draw=lines key=w words="edges triangles topology" doc="Edges of the triangles."
const uint MODE_WIREFRAME = 218u;
//@mode overdraw "Overdraw" group="Geometry" encode=color components=1 unit="layers" range=0..10 draw=layers words="layers" doc="Number of fragments, hidden or not; white 10."
const uint MODE_OVERDRAW = 219u;

//@mode base-color "Base color" group="Material" encode=color key=b words="albedo diffuse" doc="Texture times factor times vertex color, linear RGB."
const uint MODE_BASE_COLOR = 100u;
//@mode alpha "Alpha" group="Material" encode=data components=1 words="opacity coverage transparency" doc="Coverage before the cutoff; 1 for opaque materials."
const uint MODE_ALPHA = 101u;
//@mode metallic "Metallic" group="Material" encode=data components=1 key=m words="metalness" doc="0 dielectric, 1 metal."
const uint MODE_METALLIC = 102u;
//@mode roughness "Roughness" group="Material" encode=data components=1 key=u doc="Perceptual roughness, with specular antialiasing if selected."
const uint MODE_ROUGHNESS = 103u;
//@mode ggx-alpha "Alpha of the NDF" group="Material" encode=data components=1 doc="Width of the selected NDF: roughness^2, at least 0.0025."
const uint MODE_GGX_ALPHA = 104u;
//@mode occlusion "Occlusion" group="Material" encode=data components=1 words="AO ambient" doc="1 is unoccluded. Affects only environment light."
const uint MODE_OCCLUSION = 105u;
//@mode emissive "Emissive" group="Material" encode=color unit="cd/m^2" words="emission glow" doc="Texture times factor, linear RGB, without exposure."
const uint MODE_EMISSIVE = 106u;
//@mode normal-texture "Normal texture" group="Material" encode=vector needs=normal-texture doc="Tangent-space normal, scaled and normalized."
const uint MODE_NORMAL_TEXTURE = 107u;
//@mode diffuse-color "Diffuse color" group="Material" encode=color doc="Base color times (1 - metallic)."
const uint MODE_DIFFUSE_COLOR = 108u;
//@mode f0 "F0" group="Material" encode=color doc="F at normal incidence as shaded: metal and dielectric mixed, with film."
const uint MODE_F0 = 109u;
//@mode f90 "F90" group="Material" encode=color components=1 doc="Reflectance at grazing angles: 1, or the specular factor."
const uint MODE_F90 = 110u;
//@mode ior "Index of refraction" group="Material" encode=data components=1 words="IOR refractive" doc="Index of refraction of the dielectric; default 1.5."
const uint MODE_IOR = 111u;
//@mode clearcoat "Clearcoat" group="Material" encode=data components=1 needs=clearcoat doc="Clearcoat factor: 0 none, 1 full."
const uint MODE_CLEARCOAT = 112u;
//@mode clearcoat-roughness "Clearcoat roughness" group="Material" encode=data components=1 needs=clearcoat doc="Perceptual roughness of the clearcoat."
const uint MODE_CLEARCOAT_ROUGHNESS = 113u;
//@mode clearcoat-normal "Clearcoat normal" group="Material" encode=vector needs=clearcoat doc="Normal of the clearcoat, world space."
const uint MODE_CLEARCOAT_NORMAL = 114u;
//@mode anisotropy "Anisotropy" group="Material" encode=data components=1 needs=anisotropy doc="Anisotropy strength: 0 round, 1 most stretched."
const uint MODE_ANISOTROPY = 115u;
//@mode anisotropy-direction "Anisotropy axis" group="Material" encode=vector needs=anisotropy doc="Direction in which the lobe is stretched, world space."
const uint MODE_ANISOTROPY_DIRECTION = 116u;
//@mode sheen-color "Sheen color" group="Material" encode=color needs=sheen doc="Sheen color, linear RGB; black is no sheen."
const uint MODE_SHEEN_COLOR = 117u;
//@mode sheen-roughness "Sheen roughness" group="Material" encode=data components=1 needs=sheen doc="Perceptual roughness of the sheen."
const uint MODE_SHEEN_ROUGHNESS = 118u;
//@mode specular-factor "Specular factor" group="Material" encode=data components=1 needs=specular doc="F90 of the dielectric."
const uint MODE_SPECULAR_FACTOR = 119u;
//@mode specular-color "Specular color" group="Material" encode=color needs=specular,specular-glossiness doc="F0 of the dielectric without film: color, factor and ior."
const uint MODE_SPECULAR_COLOR = 120u;
//@mode iridescence "Iridescence" group="Material" encode=data components=1 needs=iridescence doc="Iridescence factor: 0 no film, 1 full."
const uint MODE_IRIDESCENCE = 121u;
//@mode iridescence-thickness "Iridescence thickness" group="Material" encode=data components=1 unit="um" needs=iridescence doc="Thickness of the thin film, micrometers."
const uint MODE_IRIDESCENCE_THICKNESS = 122u;
//@mode transmission "Transmission" group="Material" encode=data components=1 needs=transmission words="glass refraction" doc="Fraction of entering light that is transmitted."
const uint MODE_TRANSMISSION = 123u;
//@mode thickness "Thickness" group="Material" encode=data components=1 unit="m" needs=volume doc="Thickness of the volume along the refracted ray, world space, meters."
const uint MODE_THICKNESS = 124u;
//@mode attenuation-color "Attenuation color" group="Material" encode=color needs=volume doc="Color of white light after the attenuation distance."
const uint MODE_ATTENUATION_COLOR = 125u;
//@mode dispersion "Dispersion" group="Material" encode=data components=1 needs=dispersion doc="20 / Abbe number."
const uint MODE_DISPERSION = 126u;
//@mode diffuse-transmission "Diffuse transmission" group="Material" encode=data components=1 needs=diffuse-transmission doc="Fraction of diffuse light that is transmitted."
const uint MODE_DIFFUSE_TRANSMISSION = 127u;
//@mode diffuse-transmission-color "Diffuse transmission tint" group="Material" encode=color needs=diffuse-transmission doc="Color of diffusely transmitted light."
const uint MODE_DIFFUSE_TRANSMISSION_COLOR = 128u;

// D to V dot H are for the selected light, or for light 1 if all are selected.
//@mode d "Normal distribution D" group="BRDF terms" encode=data components=1 unit="1/sr" key=d words="NDF microfacet" doc="The selected NDF, 1/sr; GGX by default (Walter et al. 2007, eq. 33)."
const uint MODE_D = 300u;
//@mode g "Masking-shadowing G" group="BRDF terms" encode=data components=1 key=g words="geometry shadowing" doc="The selected masking; by default height-correlated Smith (Heitz 2014, eq. 99)."
const uint MODE_G = 301u;
//@mode v "Visibility V" group="BRDF terms" encode=data components=1 key=v doc="G / (4 NoL NoV), of the selected masking."
const uint MODE_V = 302u;
//@mode f "Fresnel F" group="BRDF terms" encode=color key=f doc="F at V dot H, dielectric and metal mixed; by default Schlick 1994, eq. 15."
const uint MODE_F = 303u;
//@mode k-d "Diffuse weight k_d" group="BRDF terms" encode=data components=1 doc="Weight of the diffuse lobe below all layers; by default (1 - metallic) (1 - R(l)) (1 - R(v)) / (1 - R_avg), R the boundary's reflectance."
const uint MODE_K_D = 304u;
//@mode k-s "Specular weight k_s" group="BRDF terms" encode=color doc="F, dielectric and metal mixed, times what the layers above transmit."
const uint MODE_K_S = 305u;
//@mode n-dot-l "N dot L" group="BRDF terms" encode=data components=1 doc="0 for light behind the surface."
const uint MODE_N_DOT_L = 306u;
//@mode n-dot-v "N dot V" group="BRDF terms" encode=data components=1 doc="|n . v|, at least 0.0001. Needs no light."
const uint MODE_N_DOT_V = 307u;
//@mode n-dot-h "N dot H" group="BRDF terms" encode=data components=1 doc="h is the half vector of l and v."
const uint MODE_N_DOT_H = 308u;
//@mode v-dot-h "V dot H" group="BRDF terms" encode=data components=1 doc="Equals L dot H: the cosine in the Fresnel term."
const uint MODE_V_DOT_H = 309u;
// For the selected light, or the sum over all lights.
//@mode diffuse-lobe "Diffuse lobe" group="BRDF terms" encode=color unit="1/sr" doc="k_d times the selected diffuse model, 1/sr; Lambert by default."
const uint MODE_DIFFUSE_LOBE = 310u;
//@mode specular-lobe "Specular lobe" group="BRDF terms" encode=color unit="1/sr" key=k doc="k_s D V with the selected D, V and F, 1/sr (Cook & Torrance 1982)."
const uint MODE_SPECULAR_LOBE = 311u;
//@mode multi-scatter-lobe "Multi-scatter lobe" group="BRDF terms" encode=color unit="1/sr" doc="The selected multiple scattering between microfacets, 1/sr."
const uint MODE_MULTI_SCATTER_LOBE = 312u;
//@mode clearcoat-lobe "Clearcoat lobe" group="BRDF terms" encode=color unit="1/sr" needs=clearcoat doc="D V of the clearcoat times its weight, 1/sr."
const uint MODE_CLEARCOAT_LOBE = 313u;
//@mode sheen-lobe "Sheen lobe" group="BRDF terms" encode=color unit="1/sr" needs=sheen doc="Sheen color times the selected sheen, 1/sr."
const uint MODE_SHEEN_LOBE = 314u;

// For the selected light or all lights. The modes from `ambient` to `luminance` ignore the selection.
//@mode dielectric "Dielectric only" group="Light" encode=color unit="cd/m^2" tonemap key=i doc="The picture with metallic 0."
const uint MODE_DIELECTRIC = 400u;
//@mode metal "Metal only" group="Light" encode=color unit="cd/m^2" tonemap key=j doc="The picture with metallic 1."
const uint MODE_METAL = 401u;
//@mode direct-diffuse "Direct diffuse" group="Light" encode=color unit="cd/m^2" tonemap doc="Light of the lights that the diffuse lobe reflects."
const uint MODE_DIRECT_DIFFUSE = 402u;
//@mode direct-specular "Direct specular" group="Light" encode=color unit="cd/m^2" tonemap doc="Light of the lights that the specular lobe reflects."
const uint MODE_DIRECT_SPECULAR = 403u;
//@mode lambert "Lambert, no cosine" group="Light" encode=color unit="cd/m^2" tonemap doc="Base color / pi times irradiance, lights head-on."
const uint MODE_LAMBERT = 404u;
//@mode ambient "Ambient" group="Light" encode=color unit="cd/m^2" tonemap doc="All environment light, or the ambient light."
const uint MODE_AMBIENT = 405u;
//@mode emissive-only "Emission" group="Light" encode=color unit="cd/m^2" tonemap doc="Emission alone, exposed like the picture."
const uint MODE_EMISSIVE_ONLY = 406u;
//@mode light-1 "Light 1" group="Light" encode=color unit="cd/m^2" tonemap doc="Light 1 alone."
const uint MODE_LIGHT_1 = 407u;
//@mode light-2 "Light 2" group="Light" encode=color unit="cd/m^2" tonemap doc="Light 2 alone."
const uint MODE_LIGHT_2 = 408u;
//@mode light-3 "Light 3" group="Light" encode=color unit="cd/m^2" tonemap doc="Light 3 alone."
const uint MODE_LIGHT_3 = 409u;
//@mode luminance "Luminance" group="Light" encode=color components=1 unit="cd/m^2" tonemap doc="Luminance Y of the picture (ITU-R BT.709)."
const uint MODE_LUMINANCE = 410u;
// Environment light.
//@mode ibl-diffuse "Environment, diffuse" group="Light" encode=color unit="cd/m^2" tonemap needs=environment doc="Irradiance times the diffuse albedo."
const uint MODE_IBL_DIFFUSE = 411u;
//@mode ibl-specular "Environment, specular" group="Light" encode=color unit="cd/m^2" tonemap needs=environment doc="Split sum: specular albedo times prefiltered radiance (Karis 2013); or the sum over samples (REFLECTION_SAMPLES)."
const uint MODE_IBL_SPECULAR = 412u;
//@mode irradiance "Irradiance" group="Light" encode=color unit="lux" tonemap needs=environment doc="Environment irradiance for the normal, lux."
const uint MODE_IRRADIANCE = 413u;
//@mode prefiltered "Prefiltered radiance" group="Light" encode=color unit="cd/m^2" tonemap needs=environment doc="Prefiltered radiance of the specular lobe: in the mirror direction for a mirror, nearer to n the rougher it is."
const uint MODE_PREFILTERED = 414u;
//@mode dfg "DFG terms" group="Light" encode=data doc="A, B, E of the selected D and V: the lobe reflects F0 A + F90 B, or E if F is 1."
const uint MODE_DFG = 415u;
// For the selected light or all lights, and the environment.
//@mode clearcoat-light "Clearcoat light" group="Light" encode=color unit="cd/m^2" tonemap needs=clearcoat doc="Light that the clearcoat reflects."
const uint MODE_CLEARCOAT_LIGHT = 416u;
//@mode sheen-light "Sheen light" group="Light" encode=color unit="cd/m^2" tonemap needs=sheen doc="Light that the sheen scatters."
const uint MODE_SHEEN_LIGHT = 417u;
//@mode transmitted-light "Transmitted light" group="Light" encode=color unit="cd/m^2" tonemap through needs=transmission,diffuse-transmission doc="Light that passes through the surface."
const uint MODE_TRANSMITTED_LIGHT = 418u;
//@mode multiple-scattering "Multiple scattering" group="Light" encode=color unit="cd/m^2" tonemap doc="Light that two microfacets or more have reflected."
const uint MODE_MULTIPLE_SCATTERING = 419u;
//@mode area-light "Area lights" group="Light" encode=color unit="cd/m^2" tonemap needs=rect-lights doc="Light of the rectangles (Heitz et al. 2016)."
const uint MODE_AREA_LIGHT = 420u;
// For all lights; these modes ignore the selection.
//@mode single-scattering "Single scattering" group="Light" encode=color unit="cd/m^2" tonemap doc="The picture without multiple scattering."
const uint MODE_SINGLE_SCATTERING = 421u;
//@mode environment "Environment" group="Light" encode=color unit="cd/m^2" tonemap needs=environment doc="Sharp mirror reflection of the environment."
const uint MODE_ENVIRONMENT = 422u;

// Lit by the selected punctual light or all punctual lights, without environment and emission.
//@mode measured "Measured" group="Measured" encode=color unit="cd/m^2" tonemap doc="Lit with the measured BRDF instead of the material."
const uint MODE_MEASURED = 600u;
//@mode measured-split "Split" group="Measured" encode=color unit="cd/m^2" tonemap doc="Left the measured BRDF, right the material."
const uint MODE_MEASURED_SPLIT = 601u;
//@mode measured-error "Error" group="Measured" encode=color doc="Against the measured BRDF: blue too dark, red too bright."
const uint MODE_MEASURED_ERROR = 602u;

//@mode nan "NaN, Inf, negative" group="Truth" encode=color numbers="finite|NaN|infinite|negative|out of range" colors="-|#ff00ff|#ffff00|#00ffff|#ff8100" key=x words="not finite infinity invalid out of range" doc="NaN magenta, Inf yellow, negative cyan; orange where the surface has a value that no material has, as a base color above 1."
const uint MODE_NAN = 500u;
//@mode negative "Negative" group="Truth" encode=color numbers="none|R|G|RG|B|RB|GB|RGB" colors="-|#ff0000|#00ff00|#ffff00|#0000ff|#ff00ff|#00ffff|#ffffff" doc="Channels below 0; valid pixels are dimmed."
const uint MODE_NEGATIVE = 501u;
//@mode clipped "Clipped" group="Truth" encode=color numbers="none|R|G|RG|B|RB|GB|RGB" colors="-|#ff0000|#00ff00|#ffff00|#0000ff|#ff00ff|#00ffff|#ffffff" words="clipping overexposed burnt saturated" doc="Channels above 1 after exposure, before tone mapping."
const uint MODE_CLIPPED = 502u;
//@mode false-color "False-color exposure" group="Truth" encode=color components=1 unit="EV" range=-6..6 colormap=heat words="exposure stops zebra" doc="Stops from middle gray: blue -6, red +6."
const uint MODE_FALSE_COLOR = 503u;
//@mode albedo-range "Albedo range" group="Truth" encode=color numbers="plausible|too dark|too bright" colors="-|#3f6cff|#ff4530" doc="Blue below sRGB 30, red above 240 (McDermott 2018); metals only outside 0..1."
const uint MODE_ALBEDO_RANGE = 504u;
//@mode f0-range "F0 range" group="Truth" encode=color numbers="plausible|too low|too high" colors="-|#3f6cff|#ff4530" doc="Blue below 0.02; red between 0.05 and metals (sRGB 180), and above 1."
const uint MODE_F0_RANGE = 505u;
// By path tracing (debug/paths.glsl). `view.bounces` limits the length of those that trace the model.
//@mode monte-carlo "Monte Carlo" group="Truth" encode=color unit="cd/m^2" tonemap accumulate stage=paths words="reference random samples" doc="The picture with an exact integral of the unoccluded environment."
const uint MODE_MONTE_CARLO = 506u;
//@mode ibl-error "Image-based light error" group="Truth" encode=vector unit="cd/m^2" accumulate stage=paths doc="Exact integral of the unoccluded environment minus the picture's: by split sum or by samples."
const uint MODE_IBL_ERROR = 507u;
//@mode energy "Energy" group="Truth" encode=data stage=paths words="furnace conservation" doc="Albedo under uniform white light; red above 1.005."
const uint MODE_ENERGY = 508u;
//@mode path-traced "Path traced" group="Truth" encode=color unit="cd/m^2" tonemap accumulate stage=paths traces words="reference ground truth ray" doc="The picture with shadows, occlusion and light between surfaces. Glass shows what the picture shows behind it: refraction is not traced."
const uint MODE_PATH_TRACED = 509u;
//@mode path-error "Error of the picture" group="Truth" encode=vector unit="cd/m^2" accumulate stage=paths traces doc="Path traced minus the picture: the sum of the five errors below."
const uint MODE_PATH_ERROR = 510u;
//@mode prefilter-error "Prefilter error" group="Truth" encode=vector unit="cd/m^2" accumulate stage=paths doc="Split sum with exact means of the environment minus with baked ones."
const uint MODE_PREFILTER_ERROR = 511u;
//@mode split-sum-error "Split sum error" group="Truth" encode=vector unit="cd/m^2" accumulate stage=paths doc="Integral of the product minus product of the integrals, both exact."
const uint MODE_SPLIT_SUM_ERROR = 512u;
//@mode occlusion-error "Occlusion error" group="Truth" encode=vector unit="cd/m^2" accumulate stage=paths traces doc="Environment light that the model blocks, minus what the texture blocks."
const uint MODE_OCCLUSION_ERROR = 513u;
//@mode shadow-error "Shadow error" group="Truth" encode=vector unit="cd/m^2" accumulate stage=paths traces doc="Light of the lamps with shadows minus without."
const uint MODE_SHADOW_ERROR = 514u;
//@mode bounce-error "Bounce error" group="Truth" encode=vector unit="cd/m^2" accumulate stage=paths traces doc="Light from other surfaces of the model, which the picture lacks."
const uint MODE_BOUNCE_ERROR = 515u;

// A value of a mode that says `numbers`: a color in a picture, the number where a single pixel is read.
vec3 number_or_color(uint number, vec3 color) { return frame.gives_numbers != 0u ? vec3(float(number)) : color; }

// Your modes: computes a mode's value from the fragment, the shaded surface and the direction to the eye.
//
//     if (MODE == MODE_HEIGHT) { value = vec3(f.position_ws.y); return true; }
bool your_mode(Fragment f, Surface s, vec3 v, out vec3 value) {
    return false;
}

#endif
