//@pass paths "Random paths" draw=model to=picture instead=model doc="The model in the light of random paths"
#version 460
#include "interface.glsl"
#include "brdf/energy/multiscatter.glsl"
#include "common/fragment.glsl"
#include "common/pixel.glsl"
#include "debug/absent.glsl"
#include "debug/paths.glsl"
#include "material/material.glsl"
#include "material/user_surface.glsl"

// One fragment of the model in a path-traced mode: what pbr.frag is for the picture.

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 out_color;

// Magenta, white at the mode's exposure: a broken formula must be seen, and must not swamp the mean.
const vec3 NOT_FINITE_COLOR = vec3(1.0, 0.0, 1.0);

void main() {
    vec3 v = safe_normalize(fragment.to_eye_ws, vec3(0.0, 0.0, 1.0));
    vec3 facet_n = facet_normal(fragment, v);
    Surface surface = make_surface(fragment, v);
    apply_user_surface(surface, fragment, v);
    if (ALPHA_MODE == ALPHA_MASK && surface.coverage < material.alpha_cutoff) discard;
    complete_surface(surface, v);

    PathValue pixel = path_value(fragment, surface, v, facet_n);
    if (pixel.not_finite) pixel.value = NOT_FINITE_COLOR / frame.exposure;
    bool is_picture = MODE == MODE_PATH_TRACED;
    float coverage = is_picture && ALPHA_MODE == ALPHA_BLEND ? surface.coverage : 1.0;
    out_color = hdr_pixel(pixel.value, coverage, no_data);
    if (pixel.not_finite) out_color.a = coverage + float(FLAG_NOT_FINITE);
    // The blend unit takes alpha for coverage, so a blended fragment of the picture has no flags.
    if (is_picture && ALPHA_MODE == ALPHA_BLEND) out_color.a = coverage;
}
