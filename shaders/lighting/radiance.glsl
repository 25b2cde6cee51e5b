// The picture: all radiance that leaves a surface towards the eye.
#ifndef LIGHTING_RADIANCE_GLSL
#define LIGHTING_RADIANCE_GLSL

#include "interface.glsl"
#include "lighting/shade.glsl"
#include "user.glsl"

vec3 reflected_radiance(Lit lit) { return lit.punctual.all + lit.area.all + lit.ambient.all + lit.behind; }

vec3 outgoing_radiance(Surface s, vec3 v, Lit lit) {
    if ((FEATURES & FEATURE_UNLIT) != 0u) return s.base_color;   // KHR_materials_unlit: a constant color

    // Emission is added, since light is additive. max() would hide the weaker of the two and leave a seam where they
    // are equal.
    return user_radiance(s, v, reflected_radiance(lit) + lit.emitted);
}

#endif
