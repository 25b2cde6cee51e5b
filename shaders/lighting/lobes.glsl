// Radiance, or the BRDF's value, split by the lobe that reflects it.
#ifndef LIGHTING_LOBES_GLSL
#define LIGHTING_LOBES_GLSL

#include "interface.glsl"
#include "brdf/evaluate.glsl"

// Light from behind the surface can contribute.
const bool LIGHT_PASSES = (FEATURES & (FEATURE_TRANSMISSION | FEATURE_DIFFUSE_TRANSMISSION)) != 0u;

// The coat's normal may differ from the base's, so the coat can face a light that the base faces away from.
bool coat_lies_apart() {
    return (FEATURES & FEATURE_CLEARCOAT) != 0u
        && (FEATURES & (FEATURE_NORMAL_TEXTURE | FEATURE_CLEARCOAT_NORMAL)) != 0u;
}

struct Lobes {
    vec3 diffuse;
    vec3 specular;             // reflected by one microfacet
    vec3 multiple;             // by more than one
    vec3 clearcoat;
    vec3 sheen;
    vec3 transmitted;          // from behind the surface, refracted or scattered
    vec3 all;                  // their sum
};

Lobes no_light() {
    return Lobes(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
}

// The sum is a field of its own: the picture reads only this field, so the driver can drop the others.
Lobes with_sum(Lobes x) {
    x.all = x.diffuse + x.specular + x.multiple + x.clearcoat + x.sheen + x.transmitted;
    return x;
}

Lobes lobes_of(Brdf brdf) {
    vec3 transmitted = brdf.transmitted + brdf.diffuse_transmitted;
    return Lobes(brdf.diffuse, brdf.specular, brdf.multiple, brdf.clearcoat, brdf.sheen, transmitted, brdf.value);
}

// sum + x * weight
void add(inout Lobes sum, Lobes x, vec3 weight) {
    sum.diffuse += x.diffuse * weight;
    sum.specular += x.specular * weight;
    sum.multiple += x.multiple * weight;
    sum.clearcoat += x.clearcoat * weight;
    sum.sheen += x.sheen * weight;
    sum.transmitted += x.transmitted * weight;
    sum.all += x.all * weight;
}

#endif
