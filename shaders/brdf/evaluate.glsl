// The BRDF, and all of it: the picture, the debug modes and every measurement call this one function.
//
//            n                    n    shading normal                  h    half vector, (l + v) / |l + v|
//        l   |   h                l    towards the light               F0   reflectance along the normal
//         \  |  /   . v           v    towards the eye                 alpha = roughness^2
//          \ | / .                NoL  max(n . l, 0), likewise NoH, VoH
//     ______\|/.______            all vectors have unit length and leave the surface, in world space
//
//   f = k_d albedo / pi + k_s D V                (Cook & Torrance 1982 over Lambert; glTF 2.0, appendix B)
//   k_d = (1 - metallic) (1 - F_dielectric)      what is not reflected enters; in a metal it is absorbed
//   k_s = mix(F_dielectric, F_metal, metallic)
//
// `metallic` mixes the results of two materials, not their F0: the dielectric's diffuse part is weakened by its own
// Fresnel term, which must not depend on the metal beside it. So f = mix(f_dielectric, f_metal, metallic), exactly.
#ifndef BRDF_EVALUATE_GLSL
#define BRDF_EVALUATE_GLSL

#include "interface.glsl"
#include "brdf/diffuse.glsl"
#include "brdf/fresnel.glsl"
#include "brdf/ndf.glsl"
#include "brdf/surface.glsl"
#include "brdf/visibility.glsl"
#include "common/math.glsl"

struct Brdf {
    float n_dot_l;
    float n_dot_v;
    float n_dot_h;
    float v_dot_h;
    float d;
    float g;
    float v;                   // G / (4 NoL NoV)
    float f_dielectric;
    vec3 f_metal;
    float k_d;
    vec3 k_s;
    vec3 diffuse;              // k_d albedo / pi, 1/sr
    vec3 specular;             // k_s D V, 1/sr
    vec3 value;                // f: their sum
};

// A normal map can turn n away from the eye, where no BRDF is defined. Clamped, such a point is seen at a grazing
// angle, not as a black hole. 1e-4 is far under a degree; with MIN_ALPHA it keeps V's denominator above zero.
const float MIN_N_DOT_V = 1e-4;

// l below the horizon: both lobes, D, G and V are 0. l = -v leaves h without a direction, and n is as good as any.
Brdf evaluate_brdf(Surface s, vec3 l, vec3 v) {
    vec3 h = safe_normalize(l + v, s.n);
    float alpha = alpha_from_roughness(s.roughness);

    Brdf f;
    f.n_dot_l = saturate(dot(s.n, l));
    f.n_dot_v = clamp(dot(s.n, v), MIN_N_DOT_V, 1.0);
    f.n_dot_h = saturate(dot(s.n, h));
    f.v_dot_h = saturate(dot(v, h));

    float above = f.n_dot_l > 0.0 ? 1.0 : 0.0;
    f.d = above * d_ggx(f.n_dot_h, alpha);
    f.v = above * v_smith_ggx(f.n_dot_l, f.n_dot_v, alpha);
    f.g = 4.0 * f.n_dot_l * f.n_dot_v * f.v;
    f.f_dielectric = f_schlick(DIELECTRIC_F0, f.v_dot_h);
    f.f_metal = f_schlick(s.base_color, f.v_dot_h);

    f.k_d = (1.0 - s.metallic) * (1.0 - f.f_dielectric);
    f.k_s = mix(vec3(f.f_dielectric), f.f_metal, s.metallic);
    f.diffuse = above * f.k_d * f_lambert(s.base_color);
    f.specular = f.k_s * (f.d * f.v);
    f.value = f.diffuse + f.specular;
    return f;
}

#endif
