// The weight of the split sum's first factor, the mean radiance of a lobe.
#ifndef IBL_SAMPLING_LOBE_WEIGHT_GLSL
#define IBL_SAMPLING_LOBE_WEIGHT_GLSL

#include "brdf/ndf.glsl"
#include "brdf/surface.glsl"
#include "brdf/visibility.glsl"

// 0.999: at alpha = 1, GGX is flat.
float lobe_alpha(float roughness) { return min(alpha_from_roughness(roughness), 0.999); }

// K = D V NoL of light that arrives at 1 - 2x to n = v, where x = sin^2 of the angle between n and h.
float lobe_weight(float x, float alpha) {
    float n_dot_l = 1.0 - 2.0 * x;
    return n_dot_l > 0.0 ? d_specular(sqrt(1.0 - x), x, alpha) * v_specular(n_dot_l, 1.0, alpha) * n_dot_l : 0.0;
}

// False for values that D and V must not have. They count as 0.
bool is_weight(float k) { return k >= 0.0 && k < 1e20; }

// alpha of a lobe that light from directions with the variance `spread` along one axis widens. Half vectors have a quarter of that
// variance. Around its peak, GGX is proportional to exp(-2 theta^2 / alpha^2), so its half vectors have the variance alpha^2 / 4,
// and alpha^2 grows by the variance. Beckmann's exp(-theta^2 / alpha^2) has alpha^2 / 2, and grows by half of it. Exact to the second
// order of the ratio of the widths; an edited D counts as the one that it replaces.
float widened_alpha(float alpha, float spread) { return sqrt(alpha * alpha + (NDF == BECKMANN ? 0.5 : 1.0) * spread); }

// K of a small light, whose directions have the variance `spread` along one axis. x: of its center.
float lobe_weight_of_light(float x, float alpha, float spread) {
    float k = lobe_weight(x, widened_alpha(alpha, spread));
    return is_weight(k) ? k : 0.0;
}

#endif
