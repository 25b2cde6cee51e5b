// Include this in a mesh stage: a file passes/NAME.mesh beside the NAME.frag of a pass with draw=model. It runs in place of a vertex
// stage, on devices with VK_EXT_mesh_shader. Specula divides the triangles of each primitive into groups, in the order of
// the indices, and starts a workgroup for each group, with one invocation for each triangle. This stage draws the model as it is:
//
//   #version 460
//   #include "common/model.mesh.glsl"
//   void main() {
//       begin_group();
//       if (!has_triangle()) return;
//       for (int i = 0; i < 3; ++i) set_corner(i, load_corner(i));
//       set_triangle();
//   }
//
// A task stage, NAME.task, can leave out whole groups (common/model.task.glsl). The mesh stage beside it says so with the line
// `#define AFTER_TASK` before the include.
#ifndef COMMON_MODEL_MESH_GLSL
#define COMMON_MODEL_MESH_GLSL

#extension GL_EXT_mesh_shader : require

#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "common/place.glsl"
#include "common/to_world.glsl"
#include "user/vertex.glsl"
#ifdef AFTER_TASK
#include "common/groups.task.glsl"
#endif

// Triangles of a group, and invocations of a workgroup. Every device has 128 invocations, 256 vertices and 256 triangles.
// With other numbers, declare layouts of your own instead of including this file: Specula starts a workgroup for as many
// triangles as it has invocations.
const uint GROUP_TRIANGLES = 32u;

layout(local_size_x = GROUP_TRIANGLES) in;
layout(triangles, max_vertices = 3 * GROUP_TRIANGLES, max_primitives = GROUP_TRIANGLES) out;

layout(location = 0) out Fragment fragments[];

// The built-in outputs. All that are declared must be written.
out gl_MeshPerVertexEXT {
    vec4 gl_Position;
} gl_MeshVerticesEXT[];
out perprimitiveEXT gl_MeshPerPrimitiveEXT {
    int gl_PrimitiveID;
    bool gl_CullPrimitiveEXT;
} gl_MeshPrimitivesEXT[];

// The number of this group in its primitive.
uint group_number() {
#ifdef AFTER_TASK
    return started.numbers[gl_WorkGroupID.x];
#else
    return draw.first_triangle / GROUP_TRIANGLES + gl_WorkGroupID.x;
#endif
}

// The instance that this group belongs to, of a pass with instances=; what gl_InstanceIndex is in a vertex stage.
uint instance_number() {
#ifdef AFTER_TASK
    return started.instance;
#else
    return gl_WorkGroupID.y;
#endif
}

// The number of this invocation's triangle in its primitive.
uint triangle_number() { return group_number() * GROUP_TRIANGLES + gl_LocalInvocationIndex; }

// Whether there is a triangle for this invocation. The last group of a primitive may have fewer.
bool has_triangle() { return triangle_number() < draw.triangle_count; }

// Sets how many triangles the group gives. Call it first, once, in all invocations.
void begin_group() {
    uint triangles = min(draw.triangle_count - group_number() * GROUP_TRIANGLES, GROUP_TRIANGLES);
    SetMeshOutputsEXT(3u * triangles, triangles);
}

// Corner i of this invocation's triangle, as the vertex stage of the model gives it.
Fragment load_corner(int i) {
    Vertex vertex = draw.vertices.at[draw.indices.at[triangle_number()].vertex[i]];
    user_vertex(vertex);
    Fragment f = fragment_of(vertex);
    f.to_eye_ws = frame.eye_ws - f.position_ws;
    return f;
}

// Sets corner i of this invocation's triangle. The camera sees it at f.position_ws.
void set_corner(int i, Fragment f) {
    vec4 clip = place(f);
    uint at = 3u * gl_LocalInvocationIndex + uint(i);
    fragments[at] = f;
    gl_MeshVerticesEXT[at].gl_Position = clip;
}

// Joins the three corners. The fragment stage reads the number of the triangle as gl_PrimitiveID. To drop the triangle, write
// `gl_MeshPrimitivesEXT[gl_LocalInvocationIndex].gl_CullPrimitiveEXT = true;` behind this call.
void set_triangle() {
    uint first = 3u * gl_LocalInvocationIndex;
    gl_PrimitiveTriangleIndicesEXT[gl_LocalInvocationIndex] = uvec3(first, first + 1u, first + 2u);
    gl_MeshPrimitivesEXT[gl_LocalInvocationIndex].gl_PrimitiveID = int(triangle_number());
    gl_MeshPrimitivesEXT[gl_LocalInvocationIndex].gl_CullPrimitiveEXT = false;
}

#endif
