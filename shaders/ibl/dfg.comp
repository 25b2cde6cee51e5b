#version 460
#include "interface.glsl"
#include "brdf/energy/dfg.glsl"
#include "brdf/fresnel.glsl"
#include "brdf/ndf.glsl"
#include "brdf/surface.glsl"
#include "brdf/visibility.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "ibl/maps/half.glsl"

// Integrates the moments of the specular lobe (brdf/energy/dfg.glsl) with the D, V and F of the selected models, so
// that the tables follow an edit of them. One workgroup per row (roughness 0 to 1), one invocation per column.

layout(local_size_x = 128) in;
layout(set = SET_TASK, binding = BINDING_TARGET, rgba16f) writeonly uniform image2DArray target;

const uint COLUMNS = DFG_SIDE;
shared vec4 partial[COLUMNS];

vec4 sum_over_columns(vec4 own) {
    uint column = gl_LocalInvocationID.x;
    barrier();
    partial[column] = own;
    barrier();
    for (uint count = COLUMNS / 2u; count > 0u; count /= 2u) {
        if (column < count) partial[column] += partial[column + count];
        barrier();
    }
    return partial[0];
}

void store(uint slice, vec4 value) {
    uvec2 texel = gl_GlobalInvocationID.xy;
    ivec3 place = ivec3(texel.x, slice * DFG_SIDE + texel.y, 0);
    imageStore(target, place, rounded_to_half(value));
}

// A value that D, V and F must not have: the caller counts such samples as 0, and Rust warns.
bool is_wrong(float x) { return isnan(x) || isinf(x) || x < 0.0 || x > 1e20; }

// terms: a(c), b(c), 0. Either may be negative; F of a white surface and of glass, f0 a + f90 b, may not. 1e-6: rounding.
bool is_wrong(vec3 terms) {
    bool is_number = !any(isnan(terms)) && !any(isinf(terms)) && all(lessThan(abs(terms), vec3(1e3)));
    return !is_number || terms.r + terms.g < -1e-6 || 0.04 * terms.r + terms.g < -1e-6;
}

uint wrong = 0u;               // DFG_FLAG bits

float checked_d(float n_dot_h, float sin2_h, float alpha) {
    float d = d_specular(n_dot_h, sin2_h, alpha);
    if (!is_wrong(d)) return d;
    wrong |= DFG_FLAG_D;
    return 0.0;
}

// Three densities of half vectors: GGX's visible normals for alpha, which fit most D, and shares of wider ones, for a D
// that has more facets far from n. The balance heuristic weights them (Veach 1997, section 9.2.2).
const uint DENSITIES = 3u;
const float SHARE[DENSITIES] = float[](1.0, 0.05, 0.01);

float alpha_of_density(uint i, float alpha) { return i == 0u ? alpha : i == 1u ? sqrt(alpha) : 1.0; }

// Density of l from sampler i, 1/sr: the density of visible normals, G1 D VoH / NoV, times dh / dl = 1 / (4 VoH).
float pdf_of_density(uint i, vec3 v, vec3 h, float alpha) {
    return pdf_reflected(pdf_ggx_vndf(v, h, vec2(alpha_of_density(i, alpha))), dot(v, h));
}

struct Moments {
    vec4 terms;                // A, B, E
    vec4 weights;
};

// The points form a lattice, which converges fast for periodic integrands. The integrand is periodic in the azimuth; the
// substitution 3 u^2 - 2 u^3, with its derivative as a weight, makes it periodic in the radius. With 512 points, E of
// GGX and Beckmann is within 0.001; of a D as different as 1 / pi, within 0.013.
Moments moments(vec3 v, float alpha) {
    Moments sum = Moments(vec4(0.0), vec4(0.0));
    for (uint density = 0u; density < DENSITIES; ++density) {
        uint count = density == 0u ? task.samples : task.samples / 4u;
        for (uint i = 0u; i < count; ++i) {
            float u = (float(i) + 0.5) / float(count);
            vec2 point = vec2(u * u * (3.0 - 2.0 * u), fract(float(i) * 0.618033988));
            vec3 h = sample_ggx_vndf(point, v, vec2(alpha_of_density(density, alpha)));
            float c = dot(v, h);
            vec3 l = 2.0 * c * h - v;
            if (l.z <= 0.0 || c <= 0.0) continue;
            float pdf = 0.0;
            for (uint other = 0u; other < DENSITIES; ++other) pdf += SHARE[other] * pdf_of_density(other, v, h, alpha);

            float visibility = v_specular(l.z, v.z, alpha);
            // One call for both: a(c) in the first channel, b(c) in the second.
            vec3 fresnel = f_schlick(vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), c);
            if (is_wrong(visibility)) wrong |= DFG_FLAG_V;
            if (is_wrong(fresnel)) wrong |= DFG_FLAG_F;
            float lobe = checked_d(h.z, dot(h.xy, h.xy), alpha) * (is_wrong(visibility) ? 0.0 : visibility) * l.z;
            lobe *= SHARE[density] * 6.0 * u * (1.0 - u) / (pdf * float(count));
            sum.terms += lobe * vec4(is_wrong(fresnel) ? vec2(0.0) : fresnel.rg, 1.0, 0.0);
            sum.weights += lobe * f_weights(c);
        }
    }
    return sum;
}

// N, the projected area of the facets: the integral of D NoH dh, 1 for a true distribution of normals (Walter et al.
// 2007, eq. 4). Sampled by the D of three GGX; each invocation takes one sample of each.
float facet_area(float alpha) {
    float u = (float(gl_LocalInvocationID.x) + 0.5) / float(COLUMNS);
    float sum = 0.0;
    for (uint density = 0u; density < DENSITIES; ++density) {
        float a2 = pow(alpha_of_density(density, alpha), 2.0);
        float tan2 = a2 * u / (1.0 - u);
        float cos2 = 1.0 / (1.0 + tan2);
        float pdf = 0.0;
        for (uint other = 0u; other < DENSITIES; ++other) {
            float b2 = pow(alpha_of_density(other, alpha), 2.0);
            float spread = cos2 * b2 + tan2 * cos2;
            pdf += SHARE[other] * b2 / (PI * spread * spread);
        }
        sum += SHARE[density] * checked_d(sqrt(cos2), tan2 * cos2, alpha) / pdf;
    }
    float area = sum_over_columns(vec4(sum)).x / float(COLUMNS);
    // The sum is only so exact. Without the step, smooth surfaces would seem to lose what they do not.
    return abs(area - 1.0) < 2e-3 ? 1.0 : area;
}

// tan within which half of the facets' area lies, relative to GGX's, which is alpha. 128 steps of tan^2, an eighth of an
// octave each.
const float FIRST_STEP = -7.0;
const float STEP = 0.125;

float relative_width(float alpha) {
    uint column = gl_LocalInvocationID.x;
    float relative = exp(FIRST_STEP + STEP * (float(column) + 0.5));
    float tan2 = alpha * alpha * relative;
    float cos2 = 1.0 / (1.0 + tan2);
    // D NoH dh = D NoH^4 / 2 d(tan^2) d(phi)
    float area = checked_d(sqrt(cos2), tan2 * cos2, alpha) * cos2 * cos2 * tan2;
    float half_of_all = 0.5 * sum_over_columns(vec4(area)).x;
    barrier();
    partial[column] = vec4(area);
    barrier();
    float before = 0.0;
    uint i = 0u;
    while (i + 1u < COLUMNS && before + partial[i].x < half_of_all) before += partial[i++].x;
    float within = clamp((half_of_all - before) / max(partial[i].x, 1e-30), 0.0, 1.0);
    return exp(0.5 * (FIRST_STEP + STEP * (float(i) + within)));
}

void main() {
    uvec2 texel = gl_GlobalInvocationID.xy;
    float cosine = cosine_of_column(texel.x, COLUMNS);
    float n_dot_v = max(cosine, MIN_N_DOT_V);
    float alpha = alpha_from_roughness(float(texel.y) / float(task.size.y - 1u));
    float area = facet_area(alpha);
    float width = relative_width(alpha);

    Moments here = moments(vec3(sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v), alpha);
    here.terms.a = area > 1e-6 ? max(1.0 - here.terms.b / area, 0.0) : 0.0;
    store(DFG_DIRECTION, here.terms);
    store(DFG_DIRECTION_WEIGHTS, here.weights);

    // The trapezoidal rule for 2 mu dmu, mu = u^2, with columns that are equally spaced in u.
    float weight = 4.0 * cosine * sqrt(cosine) / float(COLUMNS - 1u);
    if (texel.x == COLUMNS - 1u) weight *= 0.5;
    vec4 mean = sum_over_columns(here.terms * weight);
    // The last column is the normal.
    float facing = sum_over_columns(vec4(texel.x == COLUMNS - 1u ? here.terms.b : 0.0)).x;
    store(DFG_MEAN, vec4(facing, mean.g, width, mean.a));
    store(DFG_MEAN_WEIGHTS, sum_over_columns(here.weights * weight));
    store(DFG_LOBE, vec4(mean.b, float(wrong), 0.0, 0.0));
}
