// Light that comes from everywhere: one radiance L, all around.
#ifndef LIGHTING_AMBIENT_GLSL
#define LIGHTING_AMBIENT_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"

// Integral of f L NoL over the hemisphere, roughly: L base_color. It is exact for Lambert (pi L albedo / pi) and, but
// for the rise of F at grazing angles, for a metal, whose F0 is base_color: so metals are not black. Occlusion says
// which part of the sky is hidden; a light of known direction is hidden or not, so occlusion never touches direct
// light (glTF 2.0, 3.9.3).
vec3 ambient_radiance(Surface s) { return frame.ambient * s.base_color * s.occlusion; }

#endif
