#version 460
#include "interface.glsl"
#include "common/math.glsl"

// Moves the vertices of each instance with morph targets or a skin: x counts its vertices, y and z count instances. It runs once
// for each pose. What draws the model then reads these vertices: the picture, shadow maps, images of the surface, outlines.
//
// Morph targets (glTF 2.0, 3.7.2.2): a = a0 + sum over targets of w_i d_i, for each attribute a. Colors end within 0..1.
// Skin (glTF 2.0, 3.7.3): linear blend skinning, p = sum over joints of w_j J_j p0, J_j = world from joint times inverse bind
// matrix. Normals are perpendicular to the surface, so they take the cofactor matrix of the weighted sum.
//
// Limits: linear blend skinning loses volume where joints twist (Kavan et al. 2008, "Geometric Skinning with Approximate Dual
// Quaternion Blending"). Flat normals that Specula generates for a mesh without normals are morphed like those of a file.

layout(local_size_x = 64) in;

layout(set = SET_TASK, binding = BINDING_DEFORMATIONS, scalar) readonly buffer Deformations {
    Deformation deformations[];
};

// The vertex with the displacements of all morph targets.
Vertex morphed(Vertex vertex, Deformation of, uint index) {
    for (uint i = 0u; i < of.target_count; ++i) {
        float weight = of.weights.at[i];
        if (weight == 0.0) continue;
        Displacement d = of.displacements.at[i * of.vertex_count + index];
        vertex.position += weight * d.position;
        vertex.normal += weight * d.normal;
        vertex.tangent.xyz += weight * d.tangent;
        vertex.uv0 += weight * d.uv0;
        vertex.uv1 += weight * d.uv1;
        vertex.color += weight * d.color;
    }
    vertex.color = clamp(vertex.color, 0.0, 1.0);
    return vertex;
}

// The weighted sum of the joint matrices of a vertex.
mat4x3 skin(Deformation of, uint index) {
    mat4 sum = mat4(0.0);
    for (uint i = 0u; i < of.influences_per_vertex; ++i) {
        Influence influence = of.influences.at[index * of.influences_per_vertex + i];
        if (influence.weight != 0.0) sum += influence.weight * of.joints.at[influence.joint];
    }
    return mat4x3(sum);
}

// The vertex where its joints bring it: to the object space of an instance with a skin, which is world space, or its mirror image.
Vertex skinned(Vertex vertex, mat4x3 world_from_object) {
    mat3 linear = mat3(world_from_object);
    // The cofactor matrix is the inverse transpose times the determinant, of which only the sign matters.
    float mirrored = determinant(linear) < 0.0 ? -1.0 : 1.0;
    mat3 cofactors = mat3(cross(linear[1], linear[2]), cross(linear[2], linear[0]), cross(linear[0], linear[1]));
    vertex.position = world_from_object * vec4(vertex.position, 1.0);
    vertex.normal = cofactors * vertex.normal * mirrored;
    vertex.tangent = vec4(linear * vertex.tangent.xyz, vertex.tangent.w * mirrored);
    return vertex;
}

void main() {
    uint number = gl_WorkGroupID.y + gl_NumWorkGroups.y * gl_WorkGroupID.z;
    if (number >= deformations.length()) return;
    Deformation of = deformations[number];
    uint index = gl_GlobalInvocationID.x;
    if (index >= of.vertex_count) return;

    Vertex vertex = of.vertices.at[index];
    if (of.target_count > 0u) vertex = morphed(vertex, of, index);
    if (of.influences_per_vertex > 0u) vertex = skinned(vertex, skin(of, index));
    vertex.normal = safe_normalize(vertex.normal, vec3(0.0));
    vertex.tangent.xyz = safe_normalize(vertex.tangent.xyz, vec3(0.0));
    of.moved.at[index] = vertex;
}
