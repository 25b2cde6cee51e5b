// Dispatches debug modes. MODE is a specialization constant, so the driver keeps only the selected branch and drops all
// textures and lights that only other branches read.
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

// Returns false if MODE shows the picture. Each function below handles one group of modes. `s`, `lit` and `radiance`
// are the surface of surface_of_mode and its shading under lights_of_mode.
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
