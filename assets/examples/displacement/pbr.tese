#version 460
#include "common/model.tese.glsl"
#include "user/rock.glsl"

// Rock on the model: each vertex moves along its normal, and the normal leans against the slope (see user/vertex.glsl). Where a
// mesh has two normals at a place, as at a sharp edge, the rock has a crack.

layout(triangles, fractional_odd_spacing) in;

void main() {
    fragment = between_corners();
    vec3 position_ws = fragment.position_ws;
    vec3 n = fragment.normal_ws;
    float height = rock_above(position_ws);
    vec3 slope = rock_gradient(position_ws, height);
    fragment.normal_ws = safe_normalize(n - (slope - dot(slope, n) * n), n);
    move_to(position_ws + height * n);
}
