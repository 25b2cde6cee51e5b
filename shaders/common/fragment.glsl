// Varyings from the vertex to the fragment stage: `out Fragment` there, `in Fragment` here. Interpolation leaves
// directions without unit length.
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
