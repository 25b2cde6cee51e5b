// What is seen through a surface: KHR_materials_transmission, _volume and _dispersion.
//
//        eye                       The opaque scene, drawn before, is the one thing known to be behind. A volume bends
//          \  v  |  n              the ray where it enters; where it leaves, `thickness` further on, the picture of the
//     ______\____|________         opaque scene is looked up. A thin wall bends nothing: both of its sides do, and
//            \   :                 undo each other. A rough boundary blurs: a level of the picture's mip chain.
//        exit *  :                 What lies between the exit and the thing seen there is taken as clear.
#ifndef LIGHTING_TRANSMISSION_GLSL
#define LIGHTING_TRANSMISSION_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "brdf/transmission.glsl"
#include "common/math.glsl"
#include "lighting/environment.glsl"

// The opaque scene with mip levels, as common/pixel.glsl stores it. A level is a mean of many pixels, from which flags and
// coverage cannot be told apart, so a texel with a flag counts as covered.
layout(set = SET_PASS, binding = BINDING_BEHIND) uniform sampler2D behind;

// Part of light left after `path` meters: exp(-sigma path), sigma = -log(color) / distance (Beer-Lambert;
// KHR_materials_volume). 1e-6: log(0) is -infinity, and times a path of 0 it would be NaN. The distance is infinite
// where a model gives none, so that the quotient is 0; 1e30: white lets all pass, but 0 times infinity is NaN.
vec3 attenuation(Surface s, float path) {
    if ((FEATURES & FEATURE_VOLUME) == 0u) return vec3(1.0);
    return exp(log(max(s.attenuation_color, 1e-6)) * min(path / s.attenuation_distance, 1e30));
}

// The ray inside of the volume, from Snell's law; unit. An infinite ior (0 in glTF) refracts along -n. max: an ior
// below 1 could reflect all light, for which there is no ray.
vec3 refracted(Surface s, vec3 v, float ior) { return refract(-v, s.n, ior > 0.0 ? 1.0 / max(ior, 1.0) : 0.0); }

// Where a point is in the picture of the scene, 0..1. A point behind the eye is nowhere; such a thickness reaches past
// the eye, and what is in front of the surface stands in for it.
vec2 picture_uv(vec3 position_ws) {
    vec4 clip = frame.clip_from_world * vec4(position_ws, 1.0);
    vec2 here = gl_FragCoord.xy / frame.viewport_px;
    return clip.w > 0.0 ? 0.5 + 0.5 * clip.xy / clip.w : here;
}

// Where the scene covers a pixel partly or not at all, the surroundings show: the environment, or the background. That
// one is a color of the display; divided by the exposure it is the light that (but for the tone map) looks like it.
vec3 surroundings(vec3 direction, float roughness) {
    if ((FEATURES & FEATURE_ENVIRONMENT) != 0u) return prefiltered_radiance(direction, roughness);
    return frame.background.rgb * (frame.background.a / frame.exposure);
}

// Radiance that comes out of the surface towards v, before the boundary's own losses and tint. The blurred picture:
// each level doubles the width of a texel, and roughness 1 is as wide as the picture (as in Khronos's glTF Sample
// Renderer, getTransmissionSample).
vec3 radiance_behind(Surface s, vec3 v, float ior) {
    bool thin = (FEATURES & FEATURE_VOLUME) == 0u;
    vec3 direction = thin ? -v : refracted(s, v, ior);
    vec2 uv = picture_uv(thin ? s.position_ws : s.position_ws + direction * s.thickness);
    float roughness = transmission_roughness(s.roughness, ior);
    vec4 scene = textureLod(behind, uv, log2(float(textureSize(behind, 0).x)) * roughness);
    vec3 radiance = scene.rgb + (1.0 - min(scene.a, 1.0)) * surroundings(direction, roughness);
    return radiance * attenuation(s, s.thickness);
}

// The same with an ior for each channel, spread around the middle one: n_blue - n_red = (n - 1) / Abbe number, and
// dispersion = 20 / Abbe number (KHR_materials_dispersion).
vec3 transmitted_radiance(Surface s, vec3 v) {
    if ((FEATURES & FEATURE_DISPERSION) == 0u) return radiance_behind(s, v, s.ior);
    // An infinite index has no spread; nothing bends less than air.
    float half_spread = max(s.ior - 1.0, 0.0) * s.dispersion * (0.5 / 20.0);
    float red = s.ior > 0.0 ? max(s.ior - half_spread, 1.0) : 0.0;
    return vec3(radiance_behind(s, v, red).r,
                radiance_behind(s, v, s.ior).g,
                radiance_behind(s, v, s.ior + half_spread).b);
}

#endif
