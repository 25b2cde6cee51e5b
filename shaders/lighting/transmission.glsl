// The scene seen through a surface: KHR_materials_transmission, _volume and _dispersion.
//
//        eye                       Only the opaque scene, drawn before, is visible through a surface. A volume refracts
//          \  v  |  n              the ray at the entry; at the exit, `thickness` further on, the picture of the opaque
//     ______\____|________         scene is looked up. A thin wall does not deflect the ray: its two faces cancel.
//            \   :                 A rough boundary blurs: it reads a mip level of the picture.
//        exit *  :                 Whatever lies between the exit and the opaque scene is ignored.
#ifndef LIGHTING_TRANSMISSION_GLSL
#define LIGHTING_TRANSMISSION_GLSL

#include "interface.glsl"
#include "brdf/fresnel.glsl"
#include "brdf/layers/transmission.glsl"
#include "brdf/surface.glsl"
#include "common/math.glsl"
#include "common/picture_px.glsl"
#include "lighting/environment.glsl"

// The opaque scene with mip levels, as common/pixel.glsl stores it. A level is a mean of many pixels, from which flags and
// coverage cannot be told apart, so a texel with a flag counts as covered.
uniform sampler2D behind;

// Transmittance after `path` meters: exp(-sigma path), sigma = -log(color) / distance (Beer-Lambert;
// KHR_materials_volume). 1e-6 avoids log(0) = -infinity, which a path of 0 would turn into NaN. Models that give no
// distance have an infinite one, so the quotient is 0. 1e30: for white, 0 times infinity would be NaN.
vec3 attenuation(Surface s, float path) {
    if ((FEATURES & FEATURE_VOLUME) == 0u) return vec3(1.0);
    return exp(log(max(s.attenuation_color, 1e-6)) * min(path / s.attenuation_distance, 1e30));
}

// Position of a point in the picture of the scene, 0..1. If the thickness reaches behind the eye, this falls back to
// the current pixel.
vec2 picture_uv(vec3 position_ws) {
    vec4 clip = frame.clip_from_world * vec4(position_ws, 1.0);
    vec2 here = picture_px() / frame.viewport_px;
    return clip.w > 0.0 ? 0.5 + 0.5 * clip.xy / clip.w : here;
}

// Where the scene does not fully cover a pixel, the environment or the background shows. The background is a display
// color; divided by the exposure it becomes the radiance that looks like it, apart from the tone map.
vec3 surroundings(vec3 direction, float roughness) {
    if ((FEATURES & FEATURE_ENVIRONMENT) != 0u) return prefiltered_radiance(direction, roughness);
    return frame.background.rgb * (frame.background.a / frame.exposure);
}

// Radiance that leaves the surface towards v, before the boundary's Fresnel losses and tint. Blur: each mip level
// doubles the texel size, and roughness 1 reads the level of a single texel (as in Khronos's glTF Sample Renderer,
// getTransmissionSample).
vec3 radiance_behind(Surface s, vec3 v, float ior) {
    bool thin = (FEATURES & FEATURE_VOLUME) == 0u;
    vec3 direction = thin ? -v : refracted(s.n, v, ior);
    vec2 uv = picture_uv(thin ? s.position_ws : s.position_ws + direction * s.thickness);
    float roughness = transmission_roughness(s.roughness, ior);
    vec4 scene = textureLod(behind, uv, log2(float(textureSize(behind, 0).x)) * roughness);
    vec3 radiance = scene.rgb + (1.0 - min(scene.a, 1.0)) * surroundings(direction, roughness);
    return radiance * attenuation(s, s.thickness);
}

// The same with one ior per channel, spread around green's: n_blue - n_red = (n - 1) / Abbe number, and dispersion =
// 20 / Abbe number (KHR_materials_dispersion).
vec3 transmitted_radiance(Surface s, vec3 v) {
    if ((FEATURES & FEATURE_DISPERSION) == 0u) return radiance_behind(s, v, s.ior);
    // An infinite index has no dispersion; no index goes below that of air.
    float half_spread = max(s.ior - 1.0, 0.0) * s.dispersion * (0.5 / 20.0);
    float red = s.ior > 0.0 ? max(s.ior - half_spread, 1.0) : 0.0;
    return vec3(radiance_behind(s, v, red).r,
                radiance_behind(s, v, s.ior).g,
                radiance_behind(s, v, s.ior + half_spread).b);
}

#endif
