// The message of a task stage to the mesh workgroups that it starts. Both stages include this.
#ifndef COMMON_GROUPS_TASK_GLSL
#define COMMON_GROUPS_TASK_GLSL

#extension GL_EXT_mesh_shader : require

// Groups of triangles that one workgroup of the task stage decides about, one in each invocation.
const uint TASK_GROUPS = 32u;

struct Groups {
    uint numbers[TASK_GROUPS];    // The group of each mesh workgroup that was started.
    uint instance;                // The instance that all of them draw.
};

taskPayloadSharedEXT Groups started;

#endif
