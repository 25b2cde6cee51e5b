// The picture: all radiance that leaves a surface towards the eye.
#ifndef LIGHTING_RADIANCE_GLSL
#define LIGHTING_RADIANCE_GLSL

#include "interface.glsl"
#include "lighting/shade.glsl"
#include "user.glsl"

vec3 reflected_radiance(Lit lit) { return lit.punctual.all + lit.area.all + lit.ambient.all + lit.behind; }

vec3 outgoing_radiance(Surface s, vec3 v, Lit lit) {
    // The base color alone with KHR_materials_unlit, whose emission is 0; points and lines without normals add theirs (glTF 2.0, 3.9).
    if ((FEATURES & FEATURE_UNLIT) != 0u) return s.base_color + s.emissive;

    // Emission is added, since light is additive. max() would hide the weaker of the two and leave a seam where they
    // are equal.
    return user_radiance(s, v, reflected_radiance(lit) + lit.emitted);
}

#endif
