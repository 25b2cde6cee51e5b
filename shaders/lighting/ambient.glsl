// Uniform ambient light: the same radiance L from all directions. Used when there is no environment.
#ifndef LIGHTING_AMBIENT_GLSL
#define LIGHTING_AMBIENT_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "lighting/lobes.glsl"

// Approximates the integral of f L NoL by L base_color. That is exact for Lambert (pi L albedo / pi) and, apart from
// the rise of F at grazing angles, for a metal, whose F0 is base_color; so metals are not black. Occlusion is the
// hidden fraction of the sky and never affects direct light (glTF 2.0, 3.9.3). Transmitted light is not reflected.
Lobes flat_light(Surface s) {
    Lobes light = no_light();
    light.diffuse = frame.ambient * s.base_color * s.occlusion;
    if ((FEATURES & FEATURE_TRANSMISSION) != 0u) light.diffuse *= 1.0 - s.transmission * (1.0 - s.metallic);
    return light;
}

#endif
