// Light that enters the surface, loses its direction and comes out again.
#ifndef BRDF_DIFFUSE_GLSL
#define BRDF_DIFFUSE_GLSL

#include "common/math.glsl"

// f = albedo / pi (Lambert 1760): the same in all directions. 1 / pi, because the cosine integrates to pi over the
// hemisphere, so that albedo is the part of the light that leaves again.
vec3 f_lambert(vec3 albedo) { return albedo / PI; }

#endif
