#version 460
#include "interface.glsl"
#include "brdf/ndf.glsl"
#include "measure/surface.glsl"

// The projected area of the microfacets equals that of the surface: integral of D NoH dh = 1 (Walter et al. 2007, eq.
// 4). One row per roughness.
//
// D is isotropic, so one angle is enough. Half of the points follow GGX's own distribution (eq. 35). The other half
// follow the cosine, in case an edited D has facets elsewhere. The balance heuristic weights both (Veach 1997, section
// 9.2.2). Sine and cosine come from tan^2, since a cosine close to 1 does not give a precise sine.

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = SET_TASK, binding = BINDING_RESULTS, scalar) writeonly buffer Results { float integral[]; };

float d_over_pdf(float tan2, float alpha) {
    float cos2 = 1.0 / (1.0 + tan2);
    float sin2 = tan2 * cos2;
    float a2 = alpha * alpha;
    float spread = cos2 * a2 + sin2;
    float pdf = 0.5 / PI * (a2 / (spread * spread) + 1.0);   // relative to the cosine, as D NoH is
    return d_specular(sqrt(cos2), sin2, alpha) / pdf;
}

void main() {
    uvec2 cell = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(cell, task.size))) return;
    float alpha = alpha_from_roughness(roughness_of_row(cell.y));
    float sum = 0.0;
    for (uint i = 0u; i < task.samples; ++i) {
        float u = (float(i) + 0.5) / float(task.samples);
        float odds = u / (1.0 - u);
        sum += d_over_pdf(alpha * alpha * odds, alpha) + d_over_pdf(odds, alpha);
    }
    integral[cell.y * task.size.x + cell.x] = sum / float(2u * task.samples);
}
