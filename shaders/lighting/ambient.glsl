// Light that comes from everywhere: one radiance L, all around. It stands in where there is no environment.
#ifndef LIGHTING_AMBIENT_GLSL
#define LIGHTING_AMBIENT_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "lighting/lobes.glsl"

// Integral of f L NoL over the hemisphere, roughly: L base_color. It is exact for Lambert (pi L albedo / pi) and, but
// for the rise of F at grazing angles, for a metal, whose F0 is base_color: so metals are not black. Occlusion says
// which part of the sky is hidden; a light of known direction is hidden or not, so occlusion never touches direct
// light (glTF 2.0, 3.9.3). What passes through the surface is not reflected.
Lobes flat_light(Surface s) {
    Lobes light = no_light();
    light.diffuse = frame.ambient * s.base_color * s.occlusion;
    if ((FEATURES & FEATURE_TRANSMISSION) != 0u) light.diffuse *= 1.0 - s.transmission * (1.0 - s.metallic);
    return light;
}

#endif
