// Diffuse models: how light that enters the surface and scatters below it leaves again. All return f in 1/sr; those
// without an albedo argument return f / albedo. The coupling (brdf/evaluate.glsl) decides how much light enters.
#ifndef BRDF_DIFFUSE_GLSL
#define BRDF_DIFFUSE_GLSL

#include "brdf/models.glsl"
#include "common/math.glsl"

// f = albedo / pi (Lambert 1760), the same in all directions. The cosine integrates to pi over the hemisphere, so
// albedo is the fraction of the light that leaves again.
vec3 f_lambert(vec3 albedo) { return albedo / PI; }

// A fit to the MERL materials (Burley 2012, section 5.3): smooth ones darken at grazing angles, where less light
// enters; rough ones brighten there and reflect light back to its source.
//
//   f = albedo / pi (1 + (FD90 - 1) (1 - NoL)^5) (1 + (FD90 - 1) (1 - NoV)^5)        FD90 = 1/2 + 2 roughness VoH^2
//
// Gains energy: at roughness 1 and grazing angles FD90 = 2.5.
float f_burley(float n_dot_l, float n_dot_v, float v_dot_h, float roughness) {
    float rise = 2.0 * roughness * v_dot_h * v_dot_h - 0.5;
    return (1.0 + rise * pow5(1.0 - n_dot_l)) * (1.0 + rise * pow5(1.0 - n_dot_v)) / PI;
}

// Burley's model, renormalized to keep its albedo below 1 (Lagarde & de Rousiers 2014, listing 1): FD90 gets an offset
// that grows from 0 to 1/2 with roughness, and the result is divided by 1 .. 1.51.
float f_renormalized_burley(float n_dot_l, float n_dot_v, float v_dot_h, float roughness) {
    float rise = roughness * (0.5 + 2.0 * v_dot_h * v_dot_h) - 1.0;
    float scale = mix(1.0, 1.0 / 1.51, roughness);
    return scale * (1.0 + rise * pow5(1.0 - n_dot_l)) * (1.0 + rise * pow5(1.0 - n_dot_v)) / PI;
}

// Oren & Nayar 1994: V-grooves with Lambertian walls, which make rough surfaces look flat. In the form of Fujii 2012,
// with compensation for light that bounces between the walls (EON: Portsmouth, Kutz & Hill 2025). A, E and E_avg are
// albedos of the white single-scattering lobe:
//
//   f_single = albedo A / pi (1 + r s / t)        s = LoV - NoL NoV        t = s > 0 ? max(NoL, NoV) : 1
//   f_multi = rho / pi (1 - E(l)) (1 - E(v)) / (1 - E_avg)     rho = albedo^2 E_avg / (1 - albedo (1 - E_avg))
//
// E(c) is the paper's polynomial, with an error below 0.1 %, which exceeds 1 by 4e-4 at c = 0, r = 1. So 1 - E is limited
// to 0 and more, as in the authors' listing. r: roughness, 0 (Lambert) to 1 (steep grooves).
float eon_albedo(float c, float r, float a) {
    float x = 1.0 - c;
    return a * (1.0 + r * x * (0.0571085289 + x * (0.491881867 + x * (0.0714429953 * x - 0.332181442))));
}

vec3 f_oren_nayar(vec3 albedo, float n_dot_l, float n_dot_v, float l_dot_v, float r) {
    float a = 1.0 / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * r);
    float average = a * (1.0 + (2.0 / 3.0 - 28.0 / (15.0 * PI)) * r);
    float projected = l_dot_v - n_dot_l * n_dot_v;   // the paper's s
    float s_over_t = projected > 0.0 ? projected / max(n_dot_l, n_dot_v) : projected;
    vec3 single = albedo * (a * (1.0 + r * s_over_t));

    // Lambert (r = 0) loses nothing, so `multi` would be 0 / 0; 1e-6 makes it 0.
    float lost = max(1.0 - average, 1e-6);
    // The series of reflections between the walls diverges for an albedo above 1, which only an edit gives. From there on it grows
    // in proportion to the albedo, as in diffuse_albedo (brdf/energy/albedo.glsl).
    vec3 bounced = min(albedo, 1.0);
    vec3 rho = albedo * bounced * average / (1.0 - bounced * lost);
    float lost_l = max(1.0 - eon_albedo(n_dot_l, r, a), 0.0);
    float lost_v = max(1.0 - eon_albedo(n_dot_v, r, a), 0.0);
    vec3 multi = rho * (lost_l * lost_v / lost);
    return (single + multi) / PI;
}

// A fit to simulated Lambertian microfacets under a Fresnel layer (Chan 2018, "Material Advances in Call of Duty:
// WWII"): a blend of a smooth and a rough lobe, plus retroreflection. g: glossiness, 0 at alpha 1.
float f_call_of_duty(float n_dot_l, float n_dot_v, float n_dot_h, float v_dot_h, float alpha) {
    float g = saturate(log2(2.0 / (alpha * alpha) - 1.0) / 18.0);
    float rough = v_dot_h + pow5(1.0 - v_dot_h);
    float smooth_lobe = (1.0 - 0.75 * pow5(1.0 - n_dot_l)) * (1.0 - 0.75 * pow5(1.0 - n_dot_v));
    float lobe = mix(rough, smooth_lobe, saturate(2.2 * g - 0.5));
    float bump = ((34.5 * g - 59.0) * g + 24.5) * v_dot_h * exp2(-max(73.2 * g - 21.2, 8.9) * sqrt(n_dot_h));
    return (lobe + bump) / PI;
}

// The cosines that diffuse models depend on.
struct Cosines {
    float n_dot_l;
    float n_dot_v;
    float n_dot_h;
    float v_dot_h;
    float l_dot_v;
};

// The selected model, 1/sr. Lamps call this, and ibl/diffuse_albedo.comp integrates it for light from all directions.
// alpha: roughness^2, limited below (brdf/surface.glsl).
vec3 f_diffuse(vec3 base_color, float roughness, float alpha, Cosines x) {
    if (DIFFUSE == OREN_NAYAR) return f_oren_nayar(base_color, x.n_dot_l, x.n_dot_v, x.l_dot_v, roughness);
    if (DIFFUSE == BURLEY) return base_color * f_burley(x.n_dot_l, x.n_dot_v, x.v_dot_h, roughness);
    if (DIFFUSE == RENORMALIZED_BURLEY) {
        return base_color * f_renormalized_burley(x.n_dot_l, x.n_dot_v, x.v_dot_h, roughness);
    }
    if (DIFFUSE == CALL_OF_DUTY) {
        return base_color * f_call_of_duty(x.n_dot_l, x.n_dot_v, x.n_dot_h, x.v_dot_h, alpha);
    }
    return f_lambert(base_color);
}

#endif
