// Sheen: fibers that stand on the surface, as on velvet, and are bright at grazing angles (KHR_materials_sheen, after
// Estevez & Kulla 2017, "Production friendly microfacet sheen BRDF").
#ifndef BRDF_SHEEN_GLSL
#define BRDF_SHEEN_GLSL

#include "common/math.glsl"

// alpha = roughness^2, as everywhere. The minimum, at roughness 0.07, limits the exponent 1 / alpha to 200, where D
// falls to half within 5 degrees of its peak.
float sheen_alpha(float sheen_roughness) { return max(sheen_roughness * sheen_roughness, 0.005); }

// D = (2 + 1 / alpha) sin^(1 / alpha) / (2 pi), "Charlie" (eq. 2): peaks where h is perpendicular to n. The integral of
// D NoH is 1. alpha = 1 -> 3 sin / (2 pi).
float d_charlie(float n_dot_h, float alpha) {
    float sin2 = 1.0 - n_dot_h * n_dot_h;
    return (2.0 + 1.0 / alpha) * pow(sin2, 0.5 / alpha) / (2.0 * PI);
}

// Lambda has no closed form. This is the paper's fit (eq. 3, table 1): coefficients for alpha 0 and 1 are blended by
// (1 - alpha)^2, and the curve is mirrored at a cosine of 1/2.
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

// V = 1 / ((1 + Lambda(l) + Lambda(v)) 4 NoL NoV): height-correlated Smith. Unbounded where l and v both graze.
float v_sheen(float n_dot_l, float n_dot_v, float alpha) {
    float shadowed = 1.0 + sheen_lambda(n_dot_l, alpha) + sheen_lambda(n_dot_v, alpha);
    return 1.0 / (4.0 * shadowed * max(n_dot_l * n_dot_v, 1e-7));
}

#endif
