// An anisotropic lobe (KHR_materials_anisotropy) as a row of isotropic ones, for light that only has tables for those.
#ifndef LIGHTING_ANISOTROPY_GLSL
#define LIGHTING_ANISOTROPY_GLSL

#include "brdf/energy/albedo.glsl"
#include "brdf/ndf.glsl"
#include "brdf/surface.glsl"
#include "brdf/visibility.glsl"
#include "common/sampling.glsl"

// A strip has the lobe's smaller alpha and a normal tilted along t by the slope x, the middle of an equal share of GGX's slopes. Their
// density is D cos^4 (D: Walter et al. 2007, eq. 33), integrated over the slopes along b: 1 / (2 a (1 + x^2 / a^2)^(3/2)). An isotropic
// lobe already has a width, so a^2 is the difference of the two alpha^2; without anisotropy all strips coincide. A strip is
// weighted like a facet with its normal, V NoL VoH / NoH (Walter et al. 2007, eq. 41), and by the selected D over GGX.
const int STRIPS = 8;

struct Strip {
    vec3 n;                    // unit, world space
    float weight;              // relative; 0 if the strip reflects nothing towards v
};

// v: towards the eye, above the surface (mirrored_to_front).
Strip strip_of_lobe(Surface s, vec3 v, int i) {
    vec2 alpha = alpha_sides(s);
    float spread = sqrt(max(alpha.x * alpha.x - alpha.y * alpha.y, 0.0));
    mat3 ts_from_ws = transpose(mat3(s.t, s.b, s.n));
    float u = (2.0 * float(i) + 1.0) / float(STRIPS) - 1.0;
    vec3 h = normalize(s.n + s.t * (spread * u * inversesqrt(1.0 - u * u)));
    vec3 l = reflect(-v, h);
    float n_dot_l = dot(s.n, l);
    float v_dot_h = dot(v, h);
    if (n_dot_l <= 0.0 || v_dot_h <= 0.0) return Strip(h, 0.0);
    float n_dot_v = n_dot_v_of(s.n, v);
    float a2_l = a2_towards(ts_from_ws * l, alpha);
    float a2_v = a2_towards(ts_from_ws * v, alpha);
    vec3 h_ts = ts_from_ws * h;
    float d = d_specular_anisotropic(h_ts, alpha) / d_ggx_reference(h_ts, alpha);
    return Strip(h, d * v_specular(n_dot_l, n_dot_v, a2_l, a2_v) * n_dot_l * v_dot_h / h_ts.z);
}

#endif
