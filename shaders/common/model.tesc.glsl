// Include this in a tessellation control stage, which says how finely each triangle of the model is divided: a file
// passes/NAME.tesc beside the NAME.frag of a pass with draw=model. passes/NAME.tese then moves the vertices of the parts
// (common/model.tese.glsl).
//
//   #version 460
//   #include "common/model.tesc.glsl"
//   void main() { divide_edges(8.0); }
#ifndef COMMON_MODEL_TESC_GLSL
#define COMMON_MODEL_TESC_GLSL

#include "interface.glsl"
#include "common/fragment.glsl"

layout(vertices = 3) out;

layout(location = 0) in Fragment corners[];
layout(location = 0) out Fragment patch_corners[];

// The largest level of every device.
const float LARGEST_LEVEL = 64.0;

// Divides each edge into this many parts: those opposite to the corners 0, 1 and 2, and those inside. A level of 0 for an edge
// drops the triangle. Triangles with a common edge must give it the same level, or cracks open.
void divide(vec3 edges, float inside) {
    patch_corners[gl_InvocationID] = corners[gl_InvocationID];
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    for (int i = 0; i < 3; ++i) gl_TessLevelOuter[i] = edges[i];
    gl_TessLevelInner[0] = inside;
}

// The level that divides the edge from a to b (world space, meters) into parts of this many pixels. A sphere around the edge
// decides, so that the level does not depend on the direction of the edge, and both triangles at an edge get the same
// (Cantlay 2011, "DirectX 11 Terrain Tessellation").
float edge_level(vec3 a, vec3 b, float part_px) {
    vec3 row = vec3(frame.clip_from_world[0].y, frame.clip_from_world[1].y, frame.clip_from_world[2].y);
    float distance_m = max(distance(0.5 * (a + b), frame.eye_ws), frame.near);
    float diameter_px = 0.5 * frame.viewport_px.y * length(row) * distance(a, b) / distance_m;
    return clamp(diameter_px / part_px, 1.0, LARGEST_LEVEL);
}

// Divides the triangle into parts whose edges have about this many pixels.
void divide_edges(float part_px) {
    vec3 a = corners[0].position_ws, b = corners[1].position_ws, c = corners[2].position_ws;
    vec3 edges = vec3(edge_level(b, c, part_px), edge_level(c, a, part_px), edge_level(a, b, part_px));
    divide(edges, max(edges.x, max(edges.y, edges.z)));
}

#endif
