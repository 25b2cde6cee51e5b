// Modes of the group BRDF terms: what evaluate_brdf finds on the way to f.
#ifndef DEBUG_TERMS_GLSL
#define DEBUG_TERMS_GLSL

#include "interface.glsl"
#include "brdf/evaluate.glsl"
#include "debug/absent.glsl"
#include "debug/modes.glsl"
#include "lighting/lobes.glsl"
#include "lighting/shade.glsl"
#include "material.glsl"

// Lobes are added up over the lights, whatever their strength: where does the BRDF send light to the eye at all? The
// other terms are those of one light, which is the first of the chosen ones. A rectangle stands at its center.
bool shows_lobes() { return MODE >= MODE_DIFFUSE_LOBE && MODE <= MODE_SHEEN_LOBE; }

bool debug_terms(Surface s, vec3 v, out vec3 value) {
    LightRange range = chosen_lights();
    bool present = !is_empty(range);
    if (MODE == MODE_CLEARCOAT_LOBE) present = present && has_feature(FEATURE_CLEARCOAT);
    if (MODE == MODE_SHEEN_LOBE) present = present && has_feature(FEATURE_SHEEN);
    if (!shows_lobes()) range.end = min(range.end, range.first + 1u);

    Brdf f;
    Lobes sum = no_light();
    for (uint i = range.first; i < range.end; ++i) {
        f = evaluate_brdf(s, illuminate(lights[i], s.position_ws).l, v);
        add(sum, lobes_of(f), vec3(1.0));
    }

    bool known = true;
    if (MODE == MODE_D) value = vec3(f.d);
    else if (MODE == MODE_G) value = vec3(f.g);
    else if (MODE == MODE_V) value = vec3(f.v);
    else if (MODE == MODE_F) value = mix(f.f_dielectric, f.f_metal, s.metallic);
    else if (MODE == MODE_K_D) value = vec3(f.k_d);
    else if (MODE == MODE_K_S) value = f.k_s;
    else if (MODE == MODE_N_DOT_L) value = vec3(f.n_dot_l);
    else if (MODE == MODE_N_DOT_V) { value = vec3(clamp(dot(s.n, v), MIN_N_DOT_V, 1.0)); present = true; }
    else if (MODE == MODE_N_DOT_H) value = vec3(f.n_dot_h);
    else if (MODE == MODE_V_DOT_H) value = vec3(f.v_dot_h);
    else if (MODE == MODE_DIFFUSE_LOBE) value = sum.diffuse;
    else if (MODE == MODE_SPECULAR_LOBE) value = sum.specular;
    else if (MODE == MODE_MULTI_SCATTER_LOBE) value = sum.multiple;
    else if (MODE == MODE_CLEARCOAT_LOBE) value = sum.clearcoat;
    else if (MODE == MODE_SHEEN_LOBE) value = sum.sheen;
    else known = false;
    if (known) value = if_present(present, value);
    return known;
}

#endif
