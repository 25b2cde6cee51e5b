// From a vertex of the mesh, which is in object space, to what the fragment stages read.
#ifndef COMMON_TO_WORLD_GLSL
#define COMMON_TO_WORLD_GLSL

#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"

// The vertex in world space. The stage sets to_eye_ws once the position is final.
Fragment fragment_of(Vertex vertex) {
    mat3 directions = mat3(draw.world_from_object);
    Fragment f;
    f.position_ws = draw.world_from_object * vec4(vertex.position, 1.0);
    f.to_eye_ws = vec3(0.0);
    // Unit length at each vertex: on a non-uniformly scaled mesh, interpolation would otherwise favor the longer normals.
    // A zero normal stays zero; the fragment stage replaces it.
    f.normal_ws = safe_normalize(draw.normal_ws_from_object * vertex.normal, vec3(0.0));
    // A mirroring transform flips cross(n, t), so the sign of the bitangent flips too.
    float mirrored = determinant(directions) < 0.0 ? -1.0 : 1.0;
    f.tangent_ws = vec4(safe_normalize(directions * vertex.tangent.xyz, vec3(0.0)), vertex.tangent.w * mirrored);
    f.uv0 = vertex.uv0;
    f.uv1 = (FEATURES & FEATURE_UV1) != 0u ? vertex.uv1 : vertex.uv0;
    f.color = (FEATURES & FEATURE_VERTEX_COLOR) != 0u ? vertex.color : vec4(1.0);
    return f;
}

#endif
