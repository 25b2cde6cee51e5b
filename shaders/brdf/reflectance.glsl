// F of a Surface: of its dielectric and its metal, by the selected equations, including the thin film.
#ifndef BRDF_REFLECTANCE_GLSL
#define BRDF_REFLECTANCE_GLSL

#include "interface.glsl"
#include "brdf/fresnel.glsl"
#include "brdf/iridescence.glsl"
#include "brdf/models.glsl"
#include "brdf/surface.glsl"
#include "common/math.glsl"

// Edge tint for metals whose n and k are not given (see complex_ior).
const vec3 EDGE_TINT = vec3(0.5);

bool has_film() { return (FEATURES & FEATURE_IRIDESCENCE) != 0u; }

// How far F has risen from F0 to F90: (1 - c)^5 for Schlick; (F - F(1)) / (1 - F(1)) for the exact equations, so that
// KHR_materials_specular's color and factor keep their meaning.
float dielectric_rise(float ior, float f) {
    float f0 = f0_from_ior(ior);
    return saturate((f - f0) / max(1.0 - f0, 1e-4));   // 1e-4: infinite ior, where F is 1 throughout
}

vec3 dielectric_fresnel(Surface s, float c) {
    float rise = pow5(1.0 - c);
    if (FRESNEL_DIELECTRIC == EXACT_DIELECTRIC) rise = dielectric_rise(s.ior, f_dielectric_exact(s.ior, c));
    vec3 f = s.f0 + (s.f90 - s.f0) * rise;
    if (has_film()) f = mix(f, f_film(s.f0, s.iridescence_ior, s.iridescence_nm, c), s.iridescence);
    return f;
}

void metal_ior(Surface s, out vec3 n, out vec3 k) {
    n = s.conductor_n;
    k = s.conductor_k;
    if ((FEATURES & FEATURE_CONDUCTOR) == 0u) complex_ior(s.base_color, EDGE_TINT, n, k);
}

// Parameters of F = f0 + (f90 - f0) (1 - c)^5 - beta c (1 - c)^6, whose integrals over the specular lobe the table
// holds (brdf/energy.glsl), and its cosine-weighted average, 2 integral F c dc.
struct FresnelCurve {
    vec3 f0;
    vec3 f90;
    vec3 beta;
    vec3 average;
};

// The average of that curve: f0 20/21 + f90 / 21 - beta / 126.
vec3 curve_average(vec3 f0, vec3 f90, vec3 beta) { return (f0 * 20.0 + f90) / 21.0 - beta / 126.0; }

// Without the film. Exact for Schlick; for the conductor the curve is exact at 0, 82 and 90 degrees (Kutz et al. 2021).
FresnelCurve bare_metal_curve(Surface s) {
    vec3 f0 = s.base_color;
    vec3 beta = vec3(0.0);
    if (FRESNEL_METAL != SCHLICK_METAL) {
        vec3 n, k;
        metal_ior(s, n, k);
        f0 = f_conductor(n, k, 1.0);
        beta = f82_beta(f0, f_conductor(n, k, COS_82));
    }
    return FresnelCurve(f0, vec3(1.0), beta, curve_average(f0, vec3(1.0), beta));
}

vec3 metal_fresnel(Surface s, float c) {
    FresnelCurve curve = bare_metal_curve(s);
    vec3 f = f_schlick(curve.f0, curve.f90, c);
    if (FRESNEL_METAL == F82_METAL) {
        float x = 1.0 - c;
        f = saturate(f - curve.beta * (c * pow5(x) * x));
    } else if (FRESNEL_METAL == CONDUCTOR_METAL) {
        vec3 n, k;
        metal_ior(s, n, k);
        f = f_conductor(n, k, c);
    }
    if (has_film()) f = mix(f, f_film(curve.f0, s.iridescence_ior, s.iridescence_nm, c), s.iridescence);
    return f;
}

// A single angle that represents the whole lobe. B / E is the mean of (1 - c)^5 over the lobe, so this angle has that
// value. F(effective_cosine) E equals the lobe's albedo exactly if F is linear in (1 - c)^5, as Schlick's is, or the
// surface is a mirror, and approximately otherwise.
float effective_cosine(vec4 dfg) { return 1.0 - pow(clamp(dfg.g / (1.0 - dfg.r), 1e-10, 1.0), 0.2); }

// Cosine-weighted mean of the cosine, 2 integral c^2 dc.
const float MEAN_COSINE = 2.0 / 3.0;

// A film's average F has no closed form. This takes F at the mean cosine and adds Schlick's rise to 1: the average of
// (1 - c)^5 is 1/21, of which F already contains (1 - 2/3)^5 = 1/243.
vec3 film_average(Surface s, vec3 f0) {
    vec3 f = f_film(f0, s.iridescence_ior, s.iridescence_nm, MEAN_COSINE);
    return f + (1.0 - f) * (1.0 / 21.0 - 1.0 / 243.0);
}

// dfg: the table entry of the direction in question (s.dfg: towards the eye).
FresnelCurve dielectric_curve(Surface s, vec4 dfg) {
    FresnelCurve curve = FresnelCurve(s.f0, vec3(s.f90), vec3(0.0), curve_average(s.f0, vec3(s.f90), vec3(0.0)));
    if (FRESNEL_DIELECTRIC == EXACT_DIELECTRIC) {
        curve.average = s.f0 + (s.f90 - s.f0) * dielectric_rise(s.ior, f_dielectric_average(s.ior));
    }
    if (has_film()) {
        curve.average = mix(curve.average, film_average(s, s.f0), s.iridescence);
    }
    if (FRESNEL_DIELECTRIC == EXACT_DIELECTRIC || has_film()) {
        curve.f0 = dielectric_fresnel(s, effective_cosine(dfg));
        curve.f90 = curve.f0;
    }
    return curve;
}

FresnelCurve metal_curve(Surface s, vec4 dfg) {
    FresnelCurve curve = bare_metal_curve(s);
    if (has_film()) {
        curve.average = mix(curve.average, film_average(s, curve.f0), s.iridescence);
        curve.f0 = metal_fresnel(s, effective_cosine(dfg));
        curve.f90 = curve.f0;
        curve.beta = vec3(0.0);
    }
    return curve;
}

// The same, towards the eye.
FresnelCurve dielectric_curve(Surface s) { return dielectric_curve(s, s.dfg); }
FresnelCurve metal_curve(Surface s) { return metal_curve(s, s.dfg); }

#endif
