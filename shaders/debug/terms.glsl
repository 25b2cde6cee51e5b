// Modes of the group BRDF terms: intermediate results of evaluate_brdf.
#ifndef DEBUG_TERMS_GLSL
#define DEBUG_TERMS_GLSL

#include "interface.glsl"
#include "brdf/evaluate.glsl"
#include "debug/absent.glsl"
#include "debug/modes.glsl"
#include "lighting/shade.glsl"
#include "material/material.glsl"

bool shows_lobes() { return MODE >= MODE_DIFFUSE_LOBE && MODE <= MODE_SHEEN_LOBE; }
bool shows_terms() { return MODE >= MODE_D && MODE <= MODE_SHEEN_LOBE; }

// Lobe modes sum over the selected lights, regardless of intensity, to show where the BRDF sends light to the eye. The
// other modes show the terms of the first selected light.
LightRange lights_of_terms() {
    LightRange range = chosen_lights();
    if (!shows_lobes()) range.end = min(range.end, range.first + 1u);
    range.for_terms = true;
    return range;
}

// `lit`: the result for lights_of_terms.
bool debug_terms(Surface s, vec3 v, Lit lit, out vec3 value) {
    if (!shows_terms()) return false;
    Brdf brdf = lit.last;
    bool present = !is_empty(lights_of_terms());
    if (MODE == MODE_D) value = vec3(brdf.distribution);
    else if (MODE == MODE_G) value = vec3(brdf.masking);
    else if (MODE == MODE_V) value = vec3(brdf.visibility);
    else if (MODE == MODE_F) value = mix(brdf.f_dielectric, brdf.f_metal, s.metallic);
    else if (MODE == MODE_K_D) value = vec3(brdf.k_d);
    else if (MODE == MODE_K_S) value = brdf.k_s;
    else if (MODE == MODE_N_DOT_L) value = vec3(brdf.n_dot_l);
    else if (MODE == MODE_N_DOT_H) value = vec3(brdf.n_dot_h);
    else if (MODE == MODE_V_DOT_H) value = vec3(brdf.v_dot_h);
    else if (MODE == MODE_DIFFUSE_LOBE) value = lit.lobes.diffuse;
    else if (MODE == MODE_SPECULAR_LOBE) value = lit.lobes.specular;
    else if (MODE == MODE_MULTI_SCATTER_LOBE) value = lit.lobes.multiple;
    else if (MODE == MODE_CLEARCOAT_LOBE) {
        value = lit.lobes.clearcoat;
        present = present && has_feature(FEATURE_CLEARCOAT);
    } else if (MODE == MODE_SHEEN_LOBE) {
        value = lit.lobes.sheen;
        present = present && has_feature(FEATURE_SHEEN);
    } else {
        value = vec3(n_dot_v_of(s.n, v));   // MODE_N_DOT_V needs no light
        present = true;
    }
    value = if_present(present, value);
    return true;
}

#endif
