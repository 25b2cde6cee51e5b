// The picture: all light that leaves a surface for the eye.
#ifndef LIGHTING_RADIANCE_GLSL
#define LIGHTING_RADIANCE_GLSL

#include "interface.glsl"
#include "lighting/shade.glsl"
#include "user.glsl"

vec3 reflected_radiance(Lit lit) { return lit.punctual.all + lit.area.all + lit.ambient.all + lit.behind; }

vec3 outgoing_radiance(Surface s, vec3 v, Lit lit) {
    if ((FEATURES & FEATURE_UNLIT) != 0u) return s.base_color;   // KHR_materials_unlit: a color, not a material

    // Emission is added, for light adds up: a lamp in the sun is brighter than a lamp or the sun. max() would swallow
    // the weaker of the two, and leave a seam where they change places.
    return user_radiance(s, v, reflected_radiance(lit) + lit.emitted);
}

#endif
