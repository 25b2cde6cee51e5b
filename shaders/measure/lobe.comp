#version 460
#include "interface.glsl"
#include "measure/surface.glsl"

// The lobes in the plane of incidence, to be plotted: columns are the angle of the eye from -90 (the light's side) to 90
// degrees; rows are roughness. The light stands at `theta_first` degrees, on the negative side.

layout(local_size_x = 8, local_size_y = 8) in;

// Each f NoV: what leaves into a solid angle, of light that arrives with an irradiance of 1, in 1/sr. Over the
// hemisphere that adds up to the albedo.
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
    // Centers of the columns: at 90 degrees itself nothing is seen.
    float theta = PI * ((float(cell.x) + 0.5) / float(task.size.x) - 0.5);
    vec3 v = direction_at(theta, 0.0);
    Surface s = measured_surface(roughness_of_row(cell.y), v);
    Brdf f = evaluate_brdf(s, l, v);
    lobes[cell.y * task.size.x + cell.x] = Lobe(f.diffuse * v.z, f.specular * v.z, f.multiple * v.z);
}
