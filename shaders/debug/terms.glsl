// Modes of the group BRDF terms: what evaluate_brdf finds on the way to f.
#ifndef DEBUG_TERMS_GLSL
#define DEBUG_TERMS_GLSL

#include "interface.glsl"
#include "brdf/evaluate.glsl"
#include "debug/absent.glsl"
#include "debug/modes.glsl"
#include "lighting/shade.glsl"

// Both lobes added up over the lights, whatever their strength: where does the BRDF send light to the eye at all?
struct Lobes {
    vec3 diffuse;
    vec3 specular;
};

Lobes sum_of_lobes(Surface s, vec3 v, LightRange range) {
    Lobes sum = Lobes(vec3(0.0), vec3(0.0));
    for (uint i = range.first; i < range.end; ++i) {
        Brdf f = evaluate_brdf(s, illuminate(lights[i], s.position_ws).l, v);
        sum.diffuse += f.diffuse;
        sum.specular += f.specular;
    }
    return sum;
}

bool debug_terms(Surface s, vec3 v, out vec3 value) {
    LightRange range = chosen_lights();
    bool present = !is_empty(range);
    vec3 l = s.n;   // without a light, N dot V is still right
    if (present) l = illuminate(lights[range.first], s.position_ws).l;
    Brdf f = evaluate_brdf(s, l, v);

    bool known = true;
    if (MODE == MODE_D) value = vec3(f.d);
    else if (MODE == MODE_G) value = vec3(f.g);
    else if (MODE == MODE_V) value = vec3(f.v);
    else if (MODE == MODE_F) value = mix(vec3(f.f_dielectric), f.f_metal, s.metallic);
    else if (MODE == MODE_K_D) value = vec3(f.k_d);
    else if (MODE == MODE_K_S) value = f.k_s;
    else if (MODE == MODE_N_DOT_L) value = vec3(f.n_dot_l);
    else if (MODE == MODE_N_DOT_V) { value = vec3(f.n_dot_v); present = true; }
    else if (MODE == MODE_N_DOT_H) value = vec3(f.n_dot_h);
    else if (MODE == MODE_V_DOT_H) value = vec3(f.v_dot_h);
    else if (MODE == MODE_DIFFUSE_LOBE) value = sum_of_lobes(s, v, range).diffuse;
    else if (MODE == MODE_SPECULAR_LOBE) value = sum_of_lobes(s, v, range).specular;
    else known = false;
    if (known) value = if_present(present, value);
    return known;
}

#endif
