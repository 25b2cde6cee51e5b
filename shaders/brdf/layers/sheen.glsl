// Sheen: fibers that stand on the surface, as on velvet, and are bright at grazing angles (KHR_materials_sheen).
//
// f_sheen is the whole lobe of white sheen. Lamps, the albedo table (ibl/sheen_albedo.comp) and the prefiltered
// environment (ibl/prefilter_sheen.comp) all call it, so an edit here reaches every light.
#ifndef BRDF_LAYERS_SHEEN_GLSL
#define BRDF_LAYERS_SHEEN_GLSL

#include "interface.glsl"
#include "common/math.glsl"

// Charlie     glTF's own: single scattering, with a fitted Lambda that lets the albedo reach 2.2. Reciprocal.
// ZeltnerLTC  a fit to all orders of scattering in a layer of fibers. Its albedo is at most 0.75. Not reciprocal.
const uint CHARLIE = 0u;
const uint ZELTNER_LTC = 1u;
//@ui "Sheen" choice Charlie=0 "glTF's lobe of fibers (Estevez & Kulla 2017)" ZeltnerLTC=1 "A transformed cosine fitted to layers of fibers, which conserves energy (Zeltner et al. 2022)" group="BRDF" doc="The lobe of fibers: Charlie is glTF's (Estevez & Kulla 2017), Zeltner et al. 2022 conserves energy"
layout(constant_id = USER_CONSTANTS + 8) const uint SHEEN = CHARLIE;

// Charlie (Estevez & Kulla 2017, "Production friendly microfacet sheen BRDF").
//
// alpha = roughness^2, as everywhere. The minimum, at roughness 0.07, limits the exponent 1 / alpha to 200, where D
// falls to half within 5 degrees of its peak.
float sheen_alpha(float sheen_roughness) { return max(sheen_roughness * sheen_roughness, 0.005); }

// D = (2 + 1 / alpha) sin^(1 / alpha) / (2 pi) (eq. 2): peaks where h is perpendicular to n. The integral of D NoH is 1.
// alpha = 1 -> 3 sin / (2 pi).
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
float v_charlie(float n_dot_l, float n_dot_v, float alpha) {
    float shadowed = 1.0 + sheen_lambda(n_dot_l, alpha) + sheen_lambda(n_dot_v, alpha);
    return 1.0 / (4.0 * shadowed * max(n_dot_l * n_dot_v, 1e-7));
}

// Zeltner, Burley & Chiang 2022, "Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines": a cosine lobe
// that a matrix M has stretched and tilted, times the albedo R of the layer of fibers towards v:
//
//            | a 0 b |
//     M^-1 = | 0 a 0 |      f NoL = R D(l),  D(l) = NoL / pi a^2 / |M^-1 l|^4      x: towards v,  z: n
//            | 0 0 1 |
//
// D integrates to 1, so the albedo is R exactly. R, a and b are the authors' fits to their simulation, in c = NoV and
// their roughness r, which is perceptual: at r = 0.5 and 0.7, R is near Charlie's albedo. The fits start at r = 0.01,
// where there is hardly any sheen left; below it R's width would be 0.
float zeltner_albedo(float c, float r) {
    float width = r * (0.0206607 + 1.58491 * r) / (0.0379424 + r * (1.32227 + r));
    float center = r * (-0.193854 + r * (-1.14885 + r * (1.7932 - 0.95943 * r * r))) / (0.046391 + r);
    float offset = r * (0.000654023 + r * (-0.0207818 + 0.119681 * r)) / (1.26264 + r * (-1.92021 + r));
    float x = (c - center) / width;
    // max: the fit dips to -2e-5.
    return max(exp(-0.5 * x * x) / (width * sqrt(2.0 * PI)) + offset, 0.0);
}

float zeltner_a(float c, float r) {
    return (2.58126 * c + 0.813703 * r) * r / (1.0 + 0.310327 * c * c + 2.60994 * c * r);
}

// b over sqrt(1 - c).
float zeltner_b(float c, float r) {
    return (r - 1.0) * r * r * r / (0.0000254053 + 1.71228 * c - 1.71506 * c * r + 1.34174 * r * r);
}

// |M^-1 l|^2 = a^2 (1 - NoL^2) + 2 a b l_x NoL + (1 + b^2) NoL^2, where l_x = (LoV - NoL NoV) / sqrt(1 - c^2). Its root
// cancels against that of b, so v = n needs no special case.
float f_zeltner(float n_dot_l, float n_dot_v, float l_dot_v, float roughness) {
    float r = max(roughness, 0.01);
    float a = zeltner_a(n_dot_v, r);
    float b = zeltner_b(n_dot_v, r);
    float b_l_x = b * (l_dot_v - n_dot_l * n_dot_v) * inversesqrt(1.0 + n_dot_v);
    float stretched = a * a * (1.0 - n_dot_l * n_dot_l) + 2.0 * a * b_l_x * n_dot_l
                    + (1.0 + b * b * (1.0 - n_dot_v)) * n_dot_l * n_dot_l;
    float density = a / stretched;
    return zeltner_albedo(n_dot_v, r) * density * density / PI;
}

// The lobe of the selected model for white sheen, 1/sr. roughness: perceptual.
float f_sheen(float n_dot_l, float n_dot_v, float n_dot_h, float v_dot_h, float roughness) {
    if (SHEEN == ZELTNER_LTC) return f_zeltner(n_dot_l, n_dot_v, 2.0 * v_dot_h * v_dot_h - 1.0, roughness);
    float alpha = sheen_alpha(roughness);
    return d_charlie(n_dot_h, alpha) * v_charlie(n_dot_l, n_dot_v, alpha);
}

#endif
