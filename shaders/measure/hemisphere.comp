#version 460
#include "interface.glsl"
#include "measure/surface.glsl"

// Samples the BRDF over the hemisphere of the eye, for the window's plot of the lobe in space. Columns are the azimuth of the eye, once
// around from that of the mirror direction; rows are its angle from the normal, from 0 to just above the horizon. The light is
// `theta_first` degrees from the normal. Roughness is `roughness_first`.

layout(local_size_x = 8, local_size_y = 8) in;

// f NoV, in 1/sr: see measure/lobe.comp.
layout(set = SET_TASK, binding = BINDING_RESULTS, scalar) writeonly buffer Results { vec3 intensity[]; };

void main() {
    uvec2 cell = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(cell, task.size))) return;
    vec3 l = direction_at(-radians(task.theta_first), 0.0);
    // Nothing is visible at exactly 90 degrees.
    float theta = 0.4999 * PI * float(cell.y) / float(max(task.size.y, 2u) - 1u);
    vec3 v = direction_at(theta, 2.0 * PI * float(cell.x) / float(task.size.x));
    Surface s = measured_surface(task.roughness_first, v);
    intensity[cell.y * task.size.x + cell.x] = evaluate_brdf(s, l, v).value * v.z;
}
