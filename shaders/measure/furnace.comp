#version 460
#include "interface.glsl"
#include "measure/surface.glsl"

// The white furnace test (Heitz 2014, section 5.2): the albedo towards the eye, for each roughness (rows) and angle of
// the eye (columns). 1 is all of the light; more is a gain of energy.

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = SET_TASK, binding = BINDING_RESULTS, scalar) writeonly buffer Results { vec3 albedo[]; };

void main() {
    uvec2 cell = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(cell, task.size))) return;
    vec3 v = direction_at(theta_of_column(cell.x), 0.0);
    Surface s = measured_surface(roughness_of_row(cell.y), v);
    albedo[cell.y * task.size.x + cell.x] = integrate(s, v);
}
