// Include this in a geometry stage: a file passes/NAME.geom beside the NAME.frag of a pass with draw=model. It gets the
// triangles of the model one by one, as `corners`, and gives any number of points, lines or triangles. This one takes the
// model apart:
//
//   #version 460
//   #include "common/model.geom.glsl"
//   layout(triangle_strip, max_vertices = 3) out;
//   void main() {
//       for (int i = 0; i < 3; ++i) {
//           copy_corner(i);
//           move_to(fragment.position_ws + 0.1 * face_normal_ws());
//           EmitVertex();
//       }
//       EndPrimitive();
//   }
//
// After EmitVertex() all outputs are undefined, so copy a corner before each. Every device gives 1024 numbers for a triangle,
// position included: 36 vertices of a `Fragment`.
#ifndef COMMON_MODEL_GEOM_GLSL
#define COMMON_MODEL_GEOM_GLSL

#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "common/place.glsl"

layout(triangles) in;

layout(location = 0) in Fragment corners[];
layout(location = 0) out Fragment fragment;

// Makes the next vertex a copy of corner i.
void copy_corner(int i) {
    fragment = corners[i];
    gl_Position = gl_in[i].gl_Position;
    gl_PrimitiveID = gl_PrimitiveIDIn;
}

// Moves the next vertex: world space, meters. `position_ws` is where the camera sees it.
void move_to(vec3 position_ws) {
    fragment.position_ws = position_ws;
    gl_Position = place(fragment);
}

// The normal of the triangle, on the side from which its corners run counterclockwise: world space, unit; 0 if it has no area.
vec3 face_normal_ws() {
    vec3 a = corners[0].position_ws;
    return safe_normalize(cross(corners[1].position_ws - a, corners[2].position_ws - a), vec3(0.0));
}

// The center of the triangle: world space, meters.
vec3 center_ws() { return (corners[0].position_ws + corners[1].position_ws + corners[2].position_ws) / 3.0; }

#endif
