// The complete BRDF. The picture, the debug modes and every measurement call evaluate_brdf.
//
//            n                    n    shading normal                  h    half vector, (l + v) / |l + v|
//        l   |   h                l    towards the light               F0   reflectance along the normal
//         \  |  /   . v           v    towards the eye; mirrored at the plane of n where n faces away from the eye
//          \ | / .                NoL  max(n . l, 0), likewise NoH, VoH           alpha = roughness^2
//     ______\|/.______            all vectors are unit, in world space, and point away from the surface
//
//   f = k_d f_diffuse + k_s D V + f_multiple     (Cook & Torrance 1982 over a diffuse base; glTF 2.0, appendix B)
//   k_s = mix(F_dielectric, F_metal, metallic)
//   k_d = (1 - metallic) (1 - R(l)) (1 - R(v)) / (1 - R_avg)
//
// R(w) is the fraction of light from w that the dielectric's boundary reflects, and R_avg its mean: a dielectric lets in
// what it does not reflect, and a metal absorbs it. (With DIFFUSE_COUPLING=GltfSample, k_d = (1 - metallic) (1 -
// F_dielectric), as in glTF's sample implementation. See `entering`.)
//
// `metallic` blends the results of two materials, not their F0: the dielectric's own Fresnel term attenuates its
// diffuse lobe and must not depend on the metal. So f = mix(f_dielectric, f_metal, metallic), exactly.
//
// Sheen and then clear coat lie above this base; each attenuates what is below it. Transmission replaces part of the
// diffuse lobe.
#ifndef BRDF_EVALUATE_GLSL
#define BRDF_EVALUATE_GLSL

#include "interface.glsl"
#include "brdf/diffuse.glsl"
#include "brdf/energy/albedo.glsl"
#include "brdf/energy/multiscatter.glsl"
#include "brdf/fresnel.glsl"
#include "brdf/horizon.glsl"
#include "brdf/layers/sheen.glsl"
#include "brdf/layers/transmission.glsl"
#include "brdf/models.glsl"
#include "brdf/ndf.glsl"
#include "brdf/reflectance.glsl"
#include "brdf/surface.glsl"
#include "brdf/visibility.glsl"
#include "common/math.glsl"

// Lobes in 1/sr, attenuated by the layers above them.
struct Brdf {
    float n_dot_l;
    float n_dot_v;
    float n_dot_h;
    float v_dot_h;
    float distribution;        // D
    float masking;             // G
    float visibility;          // V = G / (4 NoL NoV)
    vec3 f_dielectric;
    vec3 f_metal;
    float k_d;
    vec3 k_s;
    vec3 diffuse;              // k_d f_diffuse
    vec3 specular;             // k_s D V
    vec3 multiple;             // reflected by more than one microfacet
    vec3 sheen;
    vec3 clearcoat;
    vec3 transmitted;          // through the surface, a lobe around -v
    vec3 diffuse_transmitted;  // through the surface, Lambertian
    vec3 value;                // f: their sum
};

// D and V of an anisotropic specular lobe.
void stretched_lobe(Surface s, vec3 l, vec3 v, vec3 h, inout Brdf brdf) {
    vec2 alpha = alpha_sides(s);
    mat3 ts_from_ws = transpose(mat3(s.t, s.b, s.n));
    float a2_l = a2_towards(ts_from_ws * l, alpha);
    float a2_v = a2_towards(ts_from_ws * v, alpha);
    brdf.distribution = d_specular_anisotropic(vec3((ts_from_ws * h).xy, brdf.n_dot_h), alpha);
    brdf.visibility = v_specular(brdf.n_dot_l, brdf.n_dot_v, a2_l, a2_v);
}

// The fraction of light that passes the dielectric boundary on the way in and again on the way out. A colored F counts
// by its largest component, so that the diffuse lobe does not take on the complementary color (KHR_materials_specular).
//
// GltfSample: 1 - F (glTF 2.0, appendix B). Multiple scattering does not reduce it further: that lobe returns energy that
// single scattering lost between the facets and that F already counts as reflected.
//
// Albedo: (1 - R(l)) (1 - R(v)) / (1 - R_avg), with R the boundary's total reflectance (Kelemen & Szirmay-Kalos 2001).
// A white base returns exactly what the boundary transmitted. R = 1 everywhere would be 0 / 0; 1e-4 makes it 0.
float entering(Surface s, Brdf brdf, Dfg dfg_l) {
    if (DIFFUSE_COUPLING == GLTF_SAMPLE_COUPLING) return 1.0 - max_component(brdf.f_dielectric);
    return (1.0 - boundary_albedo(s, dfg_l)) * (1.0 - s.boundary) / max(1.0 - s.mean_boundary, 1e-4);
}

// KHR_materials_clearcoat: a layer with index of refraction 1.5 and its own normal and roughness,
//
//   f = mix(f_base, D V, clearcoat F)        F = F(NoV), for both the reflected and the transmitted part
//
// The caller multiplies f by |NoL| of the base normal; the quotient `turned` replaces it by NoL of the coat normal. So
// a bump of the base that turns away from the light does not darken the coat. Returns clearcoat F.
float evaluate_clearcoat(Surface s, vec3 l, vec3 v, inout Brdf brdf) {
    vec3 h = safe_normalize(l + mirrored_to_front(s.clearcoat_n, v), s.clearcoat_n);
    float n_dot_l = saturate(dot(s.clearcoat_n, l));
    float n_dot_v = n_dot_v_of(s.clearcoat_n, v);
    float alpha = alpha_from_roughness(s.clearcoat_roughness);
    float d = d_specular(saturate(dot(s.clearcoat_n, h)), sin2_between(s.clearcoat_n, h), alpha);
    float weight = s.clearcoat * f_schlick(0.04, n_dot_v);
    float turned = n_dot_l / max(abs(dot(s.n, l)), MIN_N_DOT_V) * bump_visibility(s.ng, s.clearcoat_n, l);
    brdf.clearcoat = vec3(weight * d * v_specular(n_dot_l, n_dot_v, alpha) * turned);
    return weight;
}

// Adds sheen and clear coat, and attenuates what is below them.
void cover(Surface s, vec3 l, vec3 v, float n_dot_l, inout Brdf brdf) {
    float passes = 1.0;
    if ((FEATURES & FEATURE_SHEEN) != 0u) {
        brdf.sheen = s.sheen_color * f_sheen(brdf.n_dot_l, brdf.n_dot_v, brdf.n_dot_h, brdf.v_dot_h, s.sheen_roughness);
        float stopped = max(sheen_albedo(n_dot_l, s.sheen_roughness), sheen_albedo(brdf.n_dot_v, s.sheen_roughness));
        passes = under_sheen(s, stopped);
    }
    if ((FEATURES & FEATURE_CLEARCOAT) != 0u) {
        float uncoated = 1.0 - evaluate_clearcoat(s, l, v, brdf);
        passes *= uncoated;
        brdf.sheen *= uncoated;
    }
    brdf.k_d *= passes;
    brdf.k_s *= passes;
    brdf.multiple *= passes;
    brdf.transmitted *= passes;
    brdf.diffuse_transmitted *= passes;
}

// The caller multiplies f by |n . l| and the light's irradiance. For l below the horizon only the transmitted lobes,
// and a coat whose normal still faces l, can be nonzero; D, G and V are 0. Where n and the geometric normal disagree on the
// side of l, no lobe of the base is (brdf/horizon.glsl). Without transmission, l = -v leaves h undefined; then h = n.
Brdf evaluate_brdf(Surface s, vec3 l, vec3 v) {
    const bool transmits = (FEATURES & (FEATURE_TRANSMISSION | FEATURE_DIFFUSE_TRANSMISSION)) != 0u;
    vec3 front_v = mirrored_to_front(s.n, v);
    vec3 h = safe_normalize((transmits ? mirrored_to_front(s.n, l) : l) + front_v, s.n);
    float cos_l = dot(s.n, l);
    float above = cos_l > 0.0 ? 1.0 : 0.0;
    float visible = bump_visibility(s.ng, s.n, l);

    Brdf brdf;
    brdf.n_dot_l = saturate(cos_l);
    brdf.n_dot_v = n_dot_v_of(s.n, v);
    brdf.n_dot_h = saturate(dot(s.n, h));
    brdf.v_dot_h = saturate(dot(front_v, h));
    brdf.sheen = brdf.clearcoat = brdf.transmitted = brdf.diffuse_transmitted = vec3(0.0);

    float alpha = alpha_from_roughness(s.roughness);
    if ((FEATURES & FEATURE_ANISOTROPY) != 0u) {
        stretched_lobe(s, l, front_v, h, brdf);
    } else {
        brdf.distribution = d_specular(brdf.n_dot_h, sin2_between(s.n, h), alpha);
        brdf.visibility = v_specular(brdf.n_dot_l, brdf.n_dot_v, alpha);
    }
    brdf.distribution *= above;
    brdf.visibility *= above;
    above *= visible;
    brdf.masking = 4.0 * brdf.n_dot_l * brdf.n_dot_v * brdf.visibility;
    brdf.f_dielectric = dielectric_fresnel(s, brdf.v_dot_h);
    brdf.f_metal = metal_fresnel(s, brdf.v_dot_h);

    Dfg dfg_l = s.dfg;
    if (MULTI_SCATTER == KULLA_CONTY || DIFFUSE_COUPLING == ALBEDO_COUPLING) {
        dfg_l = dfg_towards_lamp(s, l);
    }
    brdf.multiple = vec3(0.0);
    if (MULTI_SCATTER != SINGLE_SCATTER) brdf.multiple = f_multiple(s, dfg_l.lost);

    brdf.k_s = mix(brdf.f_dielectric, brdf.f_metal, s.metallic);
    brdf.k_d = (1.0 - s.metallic) * entering(s, brdf, dfg_l);
    float below = cos_l > 0.0 ? 0.0 : visible;
    if ((FEATURES & FEATURE_DIFFUSE_TRANSMISSION) != 0u) {
        // Lambertian, on the far side (KHR_materials_diffuse_transmission).
        brdf.diffuse_transmitted = f_lambert(s.diffuse_transmission_color) * (below * brdf.k_d * s.diffuse_transmission);
        brdf.k_d *= 1.0 - s.diffuse_transmission;
    }
    if ((FEATURES & FEATURE_TRANSMISSION) != 0u) {
        float transmitted = (1.0 - s.metallic) * s.transmission * below;
        float sin2_h = sin2_between(s.n, h);
        brdf.transmitted = f_transmitted(s, abs(cos_l), brdf.n_dot_v, brdf.n_dot_h, sin2_h, brdf.f_dielectric) * transmitted;
        brdf.diffuse_transmitted *= 1.0 - s.transmission;
        brdf.k_d *= 1.0 - s.transmission;
    }
    cover(s, l, v, abs(cos_l), brdf);

    Cosines cosines = Cosines(brdf.n_dot_l, brdf.n_dot_v, brdf.n_dot_h, brdf.v_dot_h, dot(l, front_v));
    brdf.diffuse = f_diffuse(s.base_color, s.roughness, alpha, cosines) * (brdf.k_d * above);
    brdf.specular = brdf.k_s * (brdf.distribution * brdf.visibility * visible);
    brdf.multiple *= above;
    brdf.sheen *= above;
    brdf.value = brdf.diffuse + brdf.specular + brdf.multiple + brdf.sheen + brdf.clearcoat + brdf.transmitted + brdf.diffuse_transmitted;
    return brdf;
}

#endif
