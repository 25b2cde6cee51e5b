// Include this in a tessellation evaluation stage, which places the vertices of the parts of a triangle that the tessellation
// control stage beside it has divided (common/model.tesc.glsl).
//
//   #version 460
//   #include "common/model.tese.glsl"
//   layout(triangles, fractional_odd_spacing) in;
//   void main() {
//       fragment = between_corners();
//       move_to(fragment.position_ws + 0.01 * sin(40.0 * fragment.position_ws.y) * fragment.normal_ws);
//   }
#ifndef COMMON_MODEL_TESE_GLSL
#define COMMON_MODEL_TESE_GLSL

#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "common/place.glsl"

layout(location = 0) in Fragment patch_corners[];
layout(location = 0) out Fragment fragment;

// The point of the flat triangle at gl_TessCoord.
Fragment between_corners() {
    Fragment a = patch_corners[0], b = patch_corners[1], c = patch_corners[2];
    vec3 w = gl_TessCoord;
    Fragment f;
    f.position_ws = w.x * a.position_ws + w.y * b.position_ws + w.z * c.position_ws;
    f.to_eye_ws = frame.eye_ws - f.position_ws;
    f.normal_ws = safe_normalize(w.x * a.normal_ws + w.y * b.normal_ws + w.z * c.normal_ws, vec3(0.0));
    vec3 tangent = w.x * a.tangent_ws.xyz + w.y * b.tangent_ws.xyz + w.z * c.tangent_ws.xyz;
    f.tangent_ws = vec4(safe_normalize(tangent, vec3(0.0)), a.tangent_ws.w);
    f.uv0 = w.x * a.uv0 + w.y * b.uv0 + w.z * c.uv0;
    f.uv1 = w.x * a.uv1 + w.y * b.uv1 + w.z * c.uv1;
    f.color = w.x * a.color + w.y * b.color + w.z * c.color;
    return f;
}

// Moves the vertex: world space, meters. `position_ws` is where the camera sees it.
void move_to(vec3 position_ws) {
    fragment.position_ws = position_ws;
    gl_Position = place(fragment);
}

#endif
