//@pass debug "Debug modes" draw=model to=picture instead=model doc="One channel, term or check in place of the picture"
#version 460
#include "interface.glsl"
#include "brdf/energy/multiscatter.glsl"
#include "common/fragment.glsl"
#include "common/pixel.glsl"
#include "debug/absent.glsl"
#include "debug/debug.glsl"
#include "lighting/radiance.glsl"
#include "lighting/shade.glsl"
#include "material/antialiasing.glsl"
#include "material/material.glsl"
#include "material/user_surface.glsl"

// One fragment of the model in a debug mode: what pbr.frag is for the picture. A stage of its own, so that an edit of the
// picture shows before the modes are compiled.

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 out_color;

void main() {
    vec3 v = safe_normalize(fragment.to_eye_ws, vec3(0.0, 0.0, 1.0));
    Surface surface = make_surface(fragment, v);
    apply_user_surface(surface, fragment, v);
    antialias_specular(surface);
    if (ALPHA_MODE == ALPHA_MASK && surface.coverage < material.alpha_cutoff) discard;
    if (MODE == EDGES_MODE) {
        // One color on the display, whatever the exposure. Edges are no data, so ranges do not follow them.
        const vec3 EDGE_COLOR = vec3(1.0, 0.42, 0.06);
        bool is_light = TONEMAP != TONEMAP_OFF;
        out_color = hdr_pixel(is_light ? EDGE_COLOR / frame.exposure : EDGE_COLOR, 1.0, !is_light);
        return;
    }
    surface = surface_of_mode(surface);
    complete_surface(surface, v);

    // Shaded once for all modes: each call would cost the driver another copy of it to compile. The mode drops the parts
    // that it does not show.
    Lit lit = shade(surface, v, lights_of_mode());
    vec3 radiance = outgoing_radiance(surface, v, lit);
    vec3 value;
    if (!debug_value(fragment, surface, v, lit, radiance, value)) value = radiance;
    out_color = hdr_pixel(value, 1.0, no_data);
}
