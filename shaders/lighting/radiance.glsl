// The picture: all light that leaves a surface for the eye.
#ifndef LIGHTING_RADIANCE_GLSL
#define LIGHTING_RADIANCE_GLSL

#include "interface.glsl"
#include "lighting/shade.glsl"
#include "user.glsl"

vec3 outgoing_radiance(Surface s, vec3 v, LightRange range) {
    if ((FEATURES & FEATURE_UNLIT) != 0u) return s.base_color;   // KHR_materials_unlit: a color, not a material

    // Emission is added, for light adds up: a lamp in the sun is brighter than a lamp or the sun. max() would swallow
    // the weaker of the two, and leave a seam where they change places.
    vec3 radiance = reflected_radiance(shade(s, v, range)) + s.emissive;
    return user_radiance(s, v, radiance);
}

#endif
