// The surface under test and the integration of its BRDF. Tangent space: z is the normal.
#ifndef MEASURE_SURFACE_GLSL
#define MEASURE_SURFACE_GLSL

#include "interface.glsl"
#include "brdf/energy/multiscatter.glsl"
#include "brdf/evaluate.glsl"
#include "brdf/surface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"

// Takes base color and metallic from the task, and glTF's defaults for the rest. `v`: towards the eye, unit.
Surface measured_surface(float roughness, vec3 v) {
    Surface s;
    s.position_ws = vec3(0.0);
    s.n = s.ng = vec3(0.0, 0.0, 1.0);
    s.base_color = task.base_color;
    s.coverage = 1.0;
    s.metallic = task.metallic;
    s.roughness = roughness;
    s.occlusion = 1.0;
    s.emissive = vec3(0.0);
    s.f0 = vec3(0.04);
    s.f90 = 1.0;
    s.ior = 1.5;
    complete_surface(s, v);
    return s;
}

// Roughness of a row and angle of a column: even steps from the first to the last value, both included.
float roughness_of_row(uint row) {
    float part = float(row) / float(max(task.size.y, 2u) - 1u);
    return mix(task.roughness_first, task.roughness_last, part);
}

float theta_of_column(uint column) {
    float part = float(column) / float(max(task.size.x, 2u) - 1u);
    return radians(mix(task.theta_first, task.theta_last, part));
}

vec3 direction_at(float theta, float phi) {
    return vec3(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
}

// Density of the samples in `integrate`: half are reflections at GGX's visible normals, half follow the cosine.
float pdf_of_both(vec3 v, vec3 l, float alpha) {
    vec3 h = safe_normalize(l + v, vec3(0.0, 0.0, 1.0));
    float facets = pdf_reflected(pdf_ggx_vndf(v, h, vec2(alpha)), dot(v, h));
    return 0.5 * (facets + pdf_cosine(l.z));
}

// Albedo towards v: integral over the hemisphere of f(l, v) NoL dl, by 2 * task.samples samples from two densities,
// weighted by the balance heuristic (Veach 1997, section 9.2.2). Samples below the horizon count as 0.
vec3 integrate(Surface s, vec3 v) {
    float alpha = alpha_from_roughness(s.roughness);
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < 2u * task.samples; ++i) {
        vec2 u = hammersley(i / 2u, task.samples);
        vec3 l = (i & 1u) == 0u ? reflect(-v, sample_ggx_vndf(u, v, vec2(alpha))) : sample_cosine(u);
        if (l.z > 0.0) sum += evaluate_brdf(s, l, v).value * (l.z / pdf_of_both(v, l, alpha));
    }
    return sum / float(2u * task.samples);
}

#endif
