// The albedo E of an anisotropic specular lobe, from tables of isotropic ones. The formulas are fits of our own, to numeric integrals of
// D V NoL; there is no publication to name.
#ifndef BRDF_ENERGY_ANISOTROPY_GLSL
#define BRDF_ENERGY_ANISOTROPY_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "brdf/visibility.glsl"

// alpha along t and b. Anisotropy raises alpha along t towards 1 (KHR_materials_anisotropy).
vec2 alpha_sides(Surface s) {
    float alpha = alpha_from_roughness(s.roughness);
    if ((FEATURES & FEATURE_ANISOTROPY) == 0u) return vec2(alpha);
    return vec2(mix(alpha, 1.0, s.anisotropy * s.anisotropy), alpha);
}

// Roughness of the isotropic lobe that has the same mean of E over all azimuths: our fit, with an error below 0.005 of E.
float table_roughness(Surface s) {
    if ((FEATURES & FEATURE_ANISOTROPY) == 0u) return s.roughness;
    vec2 alpha = alpha_sides(s);
    return sqrt(sqrt(mix(alpha.y * alpha.y, alpha.x * alpha.x, 0.46)));
}

// An isotropic lobe as the tables hold it.
struct RoundLobe {
    float cosine;
    float roughness;
};

// The isotropic lobe that has the E of the anisotropic one towards w: our fit.
//
// Where alpha_b is small, the facets only turn around b, like those of brushed grooves along b. E then depends on the
// part of w across the grooves alone: in their cross section, w seen along the grooves is as if seen from above. So the
// cosine is that of w with its part along b scaled by alpha_b / alpha_t, and alpha^2 lies between alpha_b^2 and
// alpha_t^2.
//
// A white metal keeps its light within 4.4 % for GGX and height-correlated masking, for all strengths, roughness >= 0.1
// and angles up to 88 degrees (1.5 % RMS); with separable masking within 10 %, the most at strength 1 and 88 degrees.
// With the E of table_roughness, it lost up to 39 % and gained up to 5 %.
RoundLobe lobe_of_equal_albedo(Surface s, vec3 w) {
    vec2 alpha = alpha_sides(s);
    float across = dot(s.t, w);
    float along = dot(s.b, w) * (alpha.y / alpha.x);
    float up = max(abs(dot(s.n, w)), MIN_N_DOT_V);
    float cosine = up * inversesqrt(up * up + across * across + along * along);
    float share = 0.48 + 0.09 * cosine - 0.14 * alpha.x;
    return RoundLobe(cosine, sqrt(sqrt(mix(alpha.y * alpha.y, alpha.x * alpha.x, share))));
}

#endif
