#version 460
#include "interface.glsl"
#include "common/math.glsl"
#include "ibl/sampling/filter.glsl"
#include "ibl/sampling/lobe.glsl"

// Chooses the samples of the two lobes of a pair of levels, K = D V NoL with n = v (the split sum of Karis 2013), for the
// selected D and V. One workgroup.
//
// With x = sin^2 of the angle to h, NoL = 1 - 2x, dl = 4 pi dx, and light above the horizon has x < 1/2. The density of
// samples is proportional to the sum of both sqrt(K). Sampled with K itself, the last samples would represent half the
// sky and mix the peak into it.

layout(local_size_x = 256) in;
layout(set = SET_TASK, binding = BINDING_LOBE_TARGET, scalar) buffer Target { Lobe lobe; };

// Cells of equal ratio from x = 1e-7, a tenth of the narrowest peak; the first also covers what is below. task.size.x is
// their number: drivers would unroll loops to a constant.
const uint CELLS = 1024u;
const float RATIO = 15.4249;   // log(0.5 / 1e-7)

shared float below[CELLS];     // integral of the density up to the end of each cell
shared float sample_x[LARGEST_LOBE];
shared vec2 blurred[LARGEST_LOBE];
shared vec2 partial[gl_WorkGroupSize.x];
shared uint wrong;

float end_of_cell(uint cell) { return 0.5 * exp(RATIO * (float(cell + 1u) / float(CELLS) - 1.0)); }
float start_of_cell(uint cell) { return cell == 0u ? 0.0 : end_of_cell(cell - 1u); }

// K of both lobes.
vec2 weights_at(float x) {
    vec2 alpha = alpha_of_lobes(task.level);
    vec2 k = vec2(lobe_weight(x, alpha.x), lobe_weight(x, alpha.y));
    if (!is_weight(k.x) || !is_weight(k.y)) wrong = 1u;
    return vec2(is_weight(k.x) ? k.x : 0.0, is_weight(k.y) ? k.y : 0.0);
}

// The integrals of both K over x.
vec2 integrals() {
    vec2 sum = vec2(0.0);
    for (uint cell = gl_LocalInvocationIndex; cell < task.size.x; cell += gl_WorkGroupSize.x) {
        float first = start_of_cell(cell);
        float last = end_of_cell(cell);
        sum += weights_at(0.5 * (first + last)) * (last - first);
    }
    partial[gl_LocalInvocationIndex] = sum;
    barrier();
    for (uint count = gl_WorkGroupSize.x / 2u; count > 0u; count /= 2u) {
        if (gl_LocalInvocationIndex < count) partial[gl_LocalInvocationIndex] += partial[gl_LocalInvocationIndex + count];
        barrier();
    }
    return partial[0];
}

// x such that this fraction of all samples is below it.
float x_of_fraction(float fraction) {
    float target = fraction * below[CELLS - 1u];
    uint first = 0u;
    uint last = CELLS - 1u;
    while (first < last) {
        uint middle = (first + last) / 2u;
        if (below[middle] < target) first = middle + 1u; else last = middle;
    }
    float before = first == 0u ? 0.0 : below[first - 1u];
    float within = clamp((target - before) / max(below[first] - before, 1e-30), 0.0, 1.0);
    return mix(start_of_cell(first), end_of_cell(first), within);
}

void main() {
    uint own = gl_LocalInvocationIndex;
    if (own == 0u) wrong = 0u;
    barrier();
    vec2 integral = integrals();
    for (uint cell = own; cell < task.size.x; cell += gl_WorkGroupSize.x) {
        float first = start_of_cell(cell);
        float last = end_of_cell(cell);
        vec2 k = weights_at(0.5 * (first + last)) / max(integral, vec2(1e-30));
        below[cell] = (sqrt(k.x) + sqrt(k.y)) * (last - first);
    }
    barrier();
    if (own == 0u) {
        for (uint cell = 1u; cell < task.size.x; ++cell) below[cell] += below[cell - 1u];
        // A D of 0 everywhere: uniform samples without weight.
        if (below[CELLS - 1u] <= 0.0) for (uint cell = 0u; cell < task.size.x; ++cell) below[cell] = end_of_cell(cell);
        lobe.integral = 4.0 * PI * integral;
    }
    barrier();

    // Sample i stands for the stratum from i / n to (i + 1) / n.
    float count = float(task.samples);
    for (uint i = own; i < task.samples; i += gl_WorkGroupSize.x) {
        float x = x_of_fraction((float(i) + 0.5) / count);
        float width = x_of_fraction((float(i) + 1.0) / count) - x_of_fraction(float(i) / count);
        float footprint = max(4.0 * PI * width, finest_footprint());
        vec2 k = weights_at(x);
        float sin_theta = 2.0 * sqrt(x * (1.0 - x));
        float phi = 2.0 * PI * golden_turns(i);
        vec3 direction = vec3(sin_theta * cos(phi), sin_theta * sin(phi), 1.0 - 2.0 * x);
        lobe.samples[i] = LobeSample(direction, footprint, k * width);
        sample_x[i] = x;
        blurred[i] = FILTER_VARIANCE * footprint * k;
    }
    barrier();

    // Reading each sample with a filter of variance s^2 amounts to a mean with K + laplacian(s^2 K) / 2, up to terms of
    // s^4. So K - laplacian(s^2 K) / 2 replaces K, which about halves the error. The laplacian of g(x) around an axis of
    // the unit sphere is (1 - 2x) g' + x (1 - x) g''. Here g is known at the samples; the differences span several, since
    // those of neighbors would be rounding errors.
    uint reach = max(task.samples / 32u, 1u);
    for (uint i = own; i < task.samples; i += gl_WorkGroupSize.x) {
        uint a = i - min(i, reach);
        uint b = min(i + reach, task.samples - 1u);
        float x = sample_x[i];
        float to_a = max(x - sample_x[a], 1e-12);
        float to_b = max(sample_x[b] - x, 1e-12);
        vec2 slope_a = (blurred[i] - blurred[a]) / to_a;
        vec2 slope_b = (blurred[b] - blurred[i]) / to_b;
        bool inside = a < i && i < b;
        vec2 first = inside ? (slope_a * to_b + slope_b * to_a) / (to_a + to_b) : a < i ? slope_a : slope_b;
        vec2 second = inside ? 2.0 * (slope_b - slope_a) / (to_a + to_b) : vec2(0.0);
        vec2 laplacian = (1.0 - 2.0 * x) * first + x * (1.0 - x) * second;
        vec2 k = weights_at(x);
        // At most twice K: where D has a step, the correction has no meaning.
        vec2 sharpened = clamp(k - 0.5 * laplacian, vec2(0.0), 2.0 * k);
        lobe.samples[i].weight *= sharpened / max(k, vec2(1e-30));
    }
    barrier();
    if (own == 0u) lobe.wrong = wrong;
}
