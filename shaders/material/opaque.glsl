// The rules for passes that draw the model besides the picture: what has a hole, and what hides other things.
#ifndef MATERIAL_OPAQUE_GLSL
#define MATERIAL_OPAQUE_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "material/material.glsl"
#include "material/user_surface.glsl"

// The surface as user_surface leaves it. A `discard` in user_surface cuts the pass, as it cuts the picture.
//
// Some of these passes look from elsewhere. The hook gets the direction towards the camera all the same, and it is computed here: where
// the hook does not use it, an image stays while only the camera moves. So this has no branch, whose condition would read the camera.
Surface surface_of_pass(Fragment f) {
    f.to_eye_ws = frame.eye_ws - f.position_ws;
    vec3 v = normalize(f.to_eye_ws);
    Surface s = make_surface(f, v);
    apply_user_surface(s, f, v);
    return s;
}

// Discards the holes of masked surfaces. Opaque surfaces ignore coverage (glTF 2.0, 3.9.5). The optimizer drops what decides
// nothing: an opaque surface reads no textures here.
void discard_holes(Fragment f) {
    Surface s = surface_of_pass(f);
    if (ALPHA_MODE == ALPHA_MASK && s.coverage < material.alpha_cutoff) discard;
}

// Discards what hides nothing, for shadow maps, ambient occlusion and the ground: holes, and all that blends. These passes know no
// half-tones, so what transmits hides nothing if it lets through half of the light or more (KHR_materials_transmission; a metal
// transmits none), and otherwise all.
void discard_see_through(Fragment f) {
    if (ALPHA_MODE == ALPHA_BLEND) discard;
    Surface s = surface_of_pass(f);
    if (ALPHA_MODE == ALPHA_MASK && s.coverage < material.alpha_cutoff) discard;
    if ((FEATURES & FEATURE_TRANSMISSION) != 0u && s.transmission * (1.0 - s.metallic) >= 0.5) discard;
}

#endif
