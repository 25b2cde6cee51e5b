// Include this in a task stage: a file passes/NAME.task beside a mesh stage, NAME.mesh. It decides which groups of triangles are
// drawn, one in each invocation. This one leaves out every other group:
//
//   #version 460
//   #include "common/model.task.glsl"
//   void main() {
//       uint count = list_groups(group_number() % 2u == 0u);
//       EmitMeshTasksEXT(count, 1u, 1u);
//   }
#ifndef COMMON_MODEL_TASK_GLSL
#define COMMON_MODEL_TASK_GLSL

#extension GL_EXT_mesh_shader : require

#include "interface.glsl"
#include "common/groups.task.glsl"

// As in common/model.mesh.glsl.
const uint GROUP_TRIANGLES = 32u;

layout(local_size_x = TASK_GROUPS) in;

shared uint is_kept[TASK_GROUPS];

// The number of this invocation's group in its primitive.
uint group_number() { return draw.first_triangle / GROUP_TRIANGLES + gl_GlobalInvocationID.x; }

// The instance that is drawn, of a pass with instances=.
uint instance_number() { return gl_WorkGroupID.y; }

// Lists the groups to draw, in their order, for the mesh stage, and returns their number. Call it once, in all invocations;
// `keep` is whether to draw the group of this invocation.
uint list_groups(bool keep) {
    bool is_group = group_number() * GROUP_TRIANGLES < draw.triangle_count;
    is_kept[gl_LocalInvocationIndex] = uint(keep && is_group);
    barrier();
    uint before = 0u, count = 0u;
    for (uint i = 0u; i < TASK_GROUPS; ++i) {
        before += i < gl_LocalInvocationIndex ? is_kept[i] : 0u;
        count += is_kept[i];
    }
    if (keep && is_group) started.numbers[before] = group_number();
    if (gl_LocalInvocationIndex == 0u) started.instance = gl_WorkGroupID.y;
    return count;
}

#endif
