#version 460
#include "interface.glsl"
#include "brdf/multiscatter.glsl"
#include "common/fragment.glsl"
#include "common/pixel.glsl"
#include "debug/absent.glsl"
#include "debug/debug.glsl"
#include "lighting/radiance.glsl"
#include "lighting/shade.glsl"
#include "material.glsl"
#include "material_antialiasing.glsl"
#include "user.glsl"

// One fragment of the model, or one debug mode of it: scene-referred linear RGB as common/pixel.glsl stores it.

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 out_color;

void main() {
    vec3 v = safe_normalize(fragment.to_eye_ws, vec3(0.0, 0.0, 1.0));
    Surface surface = make_surface(fragment, v);
    user_surface(surface);
    antialias_specular(surface);
    if (ALPHA_MODE == ALPHA_MASK && surface.coverage < material.alpha_cutoff) discard;
    surface = surface_of_mode(surface);
    complete_surface(surface, v);

    // Shaded once, for the picture and for all modes: each call would cost the driver another copy of it to compile.
    // The mode drops the parts that it does not show.
    Lit lit = shade(surface, v, lights_of_mode());
    vec3 radiance = outgoing_radiance(surface, v, lit);
    vec3 value;
    float coverage = 1.0;
    if (!debug_value(fragment, surface, v, lit, radiance, value)) {
        value = radiance;
        if (ALPHA_MODE == ALPHA_BLEND) coverage = surface.coverage;
    }
    out_color = hdr_pixel(value, coverage, no_data);
    // The blend unit takes alpha for coverage, so a blended fragment of the picture has no flags.
    if (ALPHA_MODE == ALPHA_BLEND && MODE == MODE_FINAL) out_color.a = coverage;
}
