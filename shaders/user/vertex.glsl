// The hook into the vertex stage. By default it changes nothing.
#ifndef USER_VERTEX_GLSL
#define USER_VERTEX_GLSL

#include "interface.glsl"
#include "user/params.glsl"

// A vertex of the mesh before its transform to world space: object space, meters. Change its position, normal, tangent,
// texture coordinates (uv0, uv1) or color here. draw.world_from_object leads to world space; frame.time_s makes the picture
// move.
//
// A new position needs a new normal. A height h along the normal n tilts n by the height's gradient g in object space:
//
//   n' = n - (g - (g . n) n), normalized       (exact on a plane; h must be small against the radius of curvature)
//
//     float phase = 20.0 * vertex.position.y + 3.0 * frame.time_s;
//     vec3 n = vertex.normal;
//     vec3 gradient = vec3(0.0, 20.0, 0.0) * 0.01 * cos(phase);
//     vertex.position += 0.01 * sin(phase) * n;
//     vertex.normal = normalize(n - (gradient - dot(gradient, n) * n));
//
// Framing, focus and path tracing still use the mesh as it was loaded. Modes that trace it say so.
void user_vertex(inout Vertex vertex) {
}

#endif
