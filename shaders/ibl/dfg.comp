#version 460
#include "interface.glsl"
#include "brdf/models.glsl"
#include "brdf/surface.glsl"
#include "brdf/visibility.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "ibl/half.glsl"

// Directional albedo of the specular lobe, for brdf/energy.glsl. With c = VoH and integrals over all l,
//
//   A = integral of D V (1 - (1 - c)^5) NoL dl      B = integral of D V (1 - c)^5 NoL dl
//   C = integral of D V c (1 - c)^6 NoL dl          E = A + B,  E_avg = 2 integral of E(mu) mu dmu over 0..1
//
// Half vectors are sampled with a density that contains D, so D cancels (Karis 2013) and brdf/ndf.glsl is not called.
// This table does not follow an edit of D, so the furnace shows the error.
//
// One workgroup per row (roughness 0 to 1), one invocation per column (NoV at texel centers). The stored 1 - E, B, C
// and 1 - E_avg keep three digits in half floats even where E is close to 1.

const uint COLUMNS = 128u;
layout(local_size_x = 128) in;
layout(set = SET_TASK, binding = BINDING_TARGET, rgba16f) writeonly uniform image2DArray target;

shared float partial[COLUMNS];

// Ratio of Beckmann's D to GGX's for the same alpha, at most 4 / e. Both densities contain NoH, which cancels.
float beckmann_over_ggx(float n_dot_h, float alpha) { return pdf_beckmann(n_dot_h, alpha) / pdf_ggx(n_dot_h, alpha); }

// Visible normals: pdf_h = G1 D VoH / NoV and dh / dl = 1 / (4 VoH), so D / pdf_l = 4 NoV / G1. The points form a
// lattice, which converges fast for periodic integrands. The integrand is periodic in the azimuth; the substitution 3
// u^2 - 2 u^3, with its derivative as a weight, makes it periodic in the radius. 512 points have an error of 0.0006,
// 1024 Hammersley points 0.0016.
vec4 terms(vec3 v, float alpha) {
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < task.samples; ++i) {
        float u = (float(i) + 0.5) / float(task.samples);
        vec2 point = vec2(u * u * (3.0 - 2.0 * u), fract(float(i) * 0.618033988));
        vec3 h = sample_ggx_vndf(point, v, vec2(alpha));
        float c = dot(v, h);
        vec3 l = 2.0 * c * h - v;
        if (l.z <= 0.0 || c <= 0.0) continue;
        float weight = 6.0 * u * (1.0 - u) * v_specular(l.z, v.z, alpha) * l.z;
        if (NDF == BECKMANN) weight *= beckmann_over_ggx(h.z, alpha);
        float grazing = pow5(1.0 - c);
        sum += weight * vec4(1.0 - grazing, grazing, c * (1.0 - c) * grazing, 0.0);
    }
    return sum * (4.0 * v.z / (g1_ggx(v, vec2(alpha)) * float(task.samples)));
}

void main() {
    uvec2 texel = gl_GlobalInvocationID.xy;
    float n_dot_v = (float(texel.x) + 0.5) / float(COLUMNS);
    float alpha = alpha_from_roughness(float(texel.y) / float(task.size.y - 1u));
    vec4 dfg = terms(vec3(sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v), alpha);

    float lost = max(1.0 - (dfg.r + dfg.g), 0.0);
    partial[texel.x] = lost * n_dot_v * (2.0 / float(COLUMNS));
    barrier();
    for (uint half_count = COLUMNS / 2u; half_count > 0u; half_count /= 2u) {
        if (texel.x < half_count) partial[texel.x] += partial[texel.x + half_count];
        barrier();
    }
    float average = rounded_to_half(vec3(partial[0])).x;
    imageStore(target, ivec3(texel, 0), vec4(rounded_to_half(vec3(lost, dfg.gb)), average));
}
