//@pass model "Model" draw=model to=picture doc="The model in the light of lamps and environment"
#version 460
#include "interface.glsl"
#include "brdf/energy/multiscatter.glsl"
#include "common/fragment.glsl"
#include "common/pixel.glsl"
#include "lighting/radiance.glsl"
#include "lighting/shade.glsl"
#include "material/antialiasing.glsl"
#include "material/material.glsl"
#include "material/user_surface.glsl"

// One fragment of the model in the picture: scene-referred linear RGB as common/pixel.glsl stores it. debug.frag and
// paths.frag do the same for the debug modes and for path tracing.

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 out_color;

void main() {
    vec3 v = safe_normalize(fragment.to_eye_ws, vec3(0.0, 0.0, 1.0));
    Surface surface = make_surface(fragment, v);
    apply_user_surface(surface, fragment, v);
    antialias_specular(surface);
    if (ALPHA_MODE == ALPHA_MASK && surface.coverage < material.alpha_cutoff) discard;
    complete_surface(surface, v);

    vec3 radiance = outgoing_radiance(surface, v, shade(surface, v, all_lights()));
    float coverage = ALPHA_MODE == ALPHA_BLEND ? surface.coverage : 1.0;
    out_color = hdr_pixel(radiance, coverage, false);
    // The blend unit takes alpha for coverage, so a blended fragment has no flags.
    if (ALPHA_MODE == ALPHA_BLEND) out_color.a = coverage;
}
