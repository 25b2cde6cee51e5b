// A surface under lights: the rendering equation (Kajiya 1986) with the integral replaced by a sum.
#ifndef LIGHTING_SHADE_GLSL
#define LIGHTING_SHADE_GLSL

#include "interface.glsl"
#include "brdf/evaluate.glsl"
#include "lighting/ambient.glsl"
#include "lighting/punctual.glsl"

// Radiance towards the eye, by origin.
struct Lit {
    vec3 diffuse;              // direct light, diffuse lobe
    vec3 specular;             // direct light, specular lobe
    vec3 ambient;
};

// Lights number first .. end - 1.
struct LightRange {
    uint first;
    uint end;
};

LightRange all_lights() { return LightRange(0u, frame.light_count); }

// What the debug modes of one light look at: the chosen light, or all. Empty if there is none, or nothing to light.
LightRange chosen_lights() {
    uint end = (FEATURES & FEATURE_UNLIT) != 0u ? 0u : frame.light_count;
    if (frame.chosen_light == 0u) return LightRange(0u, end);
    return LightRange(frame.chosen_light - 1u, min(frame.chosen_light, end));
}

bool is_empty(LightRange range) { return range.first >= range.end; }

// L = sum over lights of f E NoL, E being the irradiance on a plane that faces the light.
Lit shade(Surface s, vec3 v, LightRange range) {
    Lit lit = Lit(vec3(0.0), vec3(0.0), ambient_radiance(s));
    for (uint i = range.first; i < range.end; ++i) {
        Illumination light = illuminate(lights[i], s.position_ws);
        if (dot(s.n, light.l) <= 0.0) continue;   // behind the surface: f would be 0
        Brdf f = evaluate_brdf(s, light.l, v);
        lit.diffuse += f.diffuse * light.irradiance * f.n_dot_l;
        lit.specular += f.specular * light.irradiance * f.n_dot_l;
    }
    return lit;
}

vec3 reflected_radiance(Lit lit) { return lit.diffuse + lit.specular + lit.ambient; }

#endif
