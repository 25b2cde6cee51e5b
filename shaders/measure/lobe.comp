#version 460
#include "interface.glsl"
#include "measure/surface.glsl"

// Samples the lobes in the plane of incidence, for plots. Columns are the angle of the eye from -90 (the light's side)
// to 90 degrees; rows are roughness. The light is `theta_first` degrees from the normal, on the negative side.

layout(local_size_x = 8, local_size_y = 8) in;

// Each lobe times NoV, in 1/sr: the fraction of the irradiance that leaves per steradian. Its integral over the
// hemisphere is the albedo.
struct Lobe {
    vec3 diffuse;
    vec3 specular;
    vec3 multiple;
};

layout(set = SET_TASK, binding = BINDING_RESULTS, scalar) writeonly buffer Results { Lobe lobes[]; };

void main() {
    uvec2 cell = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(cell, task.size))) return;
    vec3 l = direction_at(-radians(task.theta_first), 0.0);
    // Column centers, since nothing is visible at exactly 90 degrees.
    float theta = PI * ((float(cell.x) + 0.5) / float(task.size.x) - 0.5);
    vec3 v = direction_at(theta, 0.0);
    Surface s = measured_surface(roughness_of_row(cell.y), v);
    Brdf brdf = evaluate_brdf(s, l, v);
    lobes[cell.y * task.size.x + cell.x] = Lobe(brdf.diffuse * v.z, brdf.specular * v.z, brdf.multiple * v.z);
}
