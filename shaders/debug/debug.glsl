// The debug override. MODE is a specialization constant: the driver keeps the one branch that is taken, drops the
// others, and with them every texture and light that only they read.
#ifndef DEBUG_DEBUG_GLSL
#define DEBUG_DEBUG_GLSL

#include "interface.glsl"
#include "common/fragment.glsl"
#include "debug/geometry.glsl"
#include "debug/light.glsl"
#include "debug/measured.glsl"
#include "debug/modes.glsl"
#include "debug/surface.glsl"
#include "debug/terms.glsl"
#include "debug/truth.glsl"
#include "lighting/shade.glsl"

// Whether MODE shows a value of its own; if not, the picture is shown. Each function answers for one group of modes.
// `s`, `lit`, `radiance`: what is shaded and what came of it, as surface_of_mode and lights_of_mode have it.
bool debug_value(Fragment f, Surface s, vec3 v, Lit lit, vec3 radiance, out vec3 value) {
    if (your_mode(f, s, v, value)) return true;
    if (debug_geometry(f, s, v, value)) return true;
    if (debug_surface(f, s, value)) return true;
    if (debug_terms(s, v, lit, value)) return true;
    if (debug_light(s, v, lit, radiance, value)) return true;
    if (debug_measured(f, s, v, lit, value)) return true;
    return debug_truth(s, v, lit, radiance, value);
}

#endif
