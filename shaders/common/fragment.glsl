// What the vertex stage hands to the fragment stage: an `out Fragment` there, an `in Fragment` here. Interpolated, so
// no direction has unit length anymore.
#ifndef COMMON_FRAGMENT_GLSL
#define COMMON_FRAGMENT_GLSL

struct Fragment {
    vec3 position_ws;
    vec3 to_eye_ws;            // meters
    vec3 normal_ws;
    vec4 tangent_ws;           // w: sign of the bitangent
    vec2 uv0;
    vec2 uv1;
    vec4 color;                // linear RGBA, 1 where the mesh has none
};

#endif
