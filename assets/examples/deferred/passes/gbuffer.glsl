// What the G-buffer holds, and of which materials.
#ifndef PASSES_GBUFFER_GLSL
#define PASSES_GBUFFER_GLSL

#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "material/antialiasing.glsl"
#include "material/material.glsl"
#include "material/user_surface.glsl"

// Materials with parameters that the G-buffer has no room for. Their pixels are 0, and stay as the model's own pass draws them.
const uint FORWARD_FEATURES = FEATURE_UNLIT | FEATURE_CLEARCOAT | FEATURE_ANISOTROPY | FEATURE_SHEEN | FEATURE_SPECULAR
    | FEATURE_IRIDESCENCE | FEATURE_TRANSMISSION | FEATURE_DIFFUSE_TRANSMISSION | FEATURE_SPECULAR_GLOSSINESS | FEATURE_CONDUCTOR;
bool is_deferred() { return ALPHA_MODE != ALPHA_BLEND && (FEATURES & FORWARD_FEATURES) == 0u; }

// The surface that pbr.frag lights, before complete_surface.
Surface gbuffer_surface(Fragment f) {
    vec3 v = safe_normalize(f.to_eye_ws, vec3(0.0, 0.0, 1.0));
    Surface s = make_surface(f, v);
    apply_user_surface(s, f, v);
    antialias_specular(s);
    if (ALPHA_MODE == ALPHA_MASK && s.coverage < material.alpha_cutoff) discard;
    return s;
}

#endif
