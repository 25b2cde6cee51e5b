// Sheen: fibers that stand on the surface, as on velvet, and shine at grazing angles (KHR_materials_sheen, after
// Estevez & Kulla 2017, "Production friendly microfacet sheen BRDF").
#ifndef BRDF_SHEEN_GLSL
#define BRDF_SHEEN_GLSL

#include "common/math.glsl"

// alpha = roughness^2, as everywhere. Below a roughness of 0.07 the lobe is less than a degree wide and its exponent
// beyond 200: nobody would see it.
float sheen_alpha(float sheen_roughness) { return max(sheen_roughness * sheen_roughness, 0.005); }

// D = (2 + 1 / alpha) sin^(1 / alpha) / (2 pi), "Charlie" (eq. 2): most facets stand upright, h at right angles to n.
// integral of D NoH = 1. alpha = 1 -> 3 sin / (2 pi).
float d_charlie(float n_dot_h, float alpha) {
    float sin2 = 1.0 - n_dot_h * n_dot_h;
    return (2.0 + 1.0 / alpha) * pow(sin2, 0.5 / alpha) / (2.0 * PI);
}

// Lambda has no formula; this is the paper's fit (eq. 3 and table 1), between alpha 0 and 1 by (1 - alpha)^2, mirrored
// at a cosine of 1/2.
float sheen_lambda_log(float c, float alpha) {
    float t = (1.0 - alpha) * (1.0 - alpha);
    float a = mix(21.5473, 25.3245, t);
    float b = mix(3.82987, 3.32435, t);
    float e = mix(0.19823, 0.16801, t);
    float d = mix(-1.97760, -1.27393, t);
    float g = mix(-4.32054, -4.85967, t);
    return a / (1.0 + b * pow(c, e)) + d * c + g;
}

float sheen_lambda(float c, float alpha) {
    float low = sheen_lambda_log(min(c, 1.0 - c), alpha);
    return exp(c < 0.5 ? low : 2.0 * sheen_lambda_log(0.5, alpha) - low);
}

// V = 1 / ((1 + Lambda(l) + Lambda(v)) 4 NoL NoV): height-correlated Smith. Grows beyond bounds where both graze.
float v_sheen(float n_dot_l, float n_dot_v, float alpha) {
    float shadowed = 1.0 + sheen_lambda(n_dot_l, alpha) + sheen_lambda(n_dot_v, alpha);
    return 1.0 / (4.0 * shadowed * max(n_dot_l * n_dot_v, 1e-7));
}

#endif
