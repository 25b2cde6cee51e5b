#version 460
#include "interface.glsl"
#include "common/math.glsl"
#include "ibl/cube_map.glsl"
#include "ibl/half.glsl"
#include "ibl/small_lights.glsl"

// From an equirectangular image to level 0 of a cube map. One invocation is a texel; z of the group is the face.
//
// Alpha is the brightest component; below, of all texels that a texel covers. So who follows it down finds the sun.
//
// The image's center column is seen looking down -Z, what is right of it towards +X:
// u = 0.5 + atan(x, -z) / 2 pi, v = acos(y) / pi.

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_TASK, binding = BINDING_SOURCE) uniform sampler2D source;
layout(set = SET_TASK, binding = BINDING_TARGET, rgba16f) writeonly uniform image2DArray target;

// acos(y) as an arctangent: acos loses half its digits near the poles. u = 0 and u = 1 are one column: the sampler
// repeats, and with a level given there is no derivative that could jump there.
vec3 radiance_from(vec3 d) {
    vec2 uv = vec2(0.5 + atan(d.x, -d.z) / (2.0 * PI), atan(length(d.xz), d.y) / PI);
    return textureLod(source, uv, 0.0).rgb;
}

// The mean over task.samples x task.samples points, so that what is smaller than a texel, such as a sun, keeps its
// energy. Within one texel each point stands for the same solid angle, nearly.
vec3 mean_radiance(uvec3 texel) {
    vec3 sum = vec3(0.0);
    float step_st = 2.0 / (float(task.size.x) * float(task.samples));
    vec2 first = vec2(texel.xy * task.samples) * step_st - 1.0 + 0.5 * step_st;
    for (uint y = 0u; y < task.samples; ++y) {
        for (uint x = 0u; x < task.samples; ++x) {
            sum += radiance_from(cube_position(first + vec2(x, y) * step_st, texel.z));
        }
    }
    return rounded_to_half(sum * (task.radiance_scale / float(task.samples * task.samples)));
}

// Counted in the group first: all of an image's texels on one counter would wait for each other.
shared uint group_count[BRIGHTNESS_STEPS];

void main() {
    uvec3 texel = gl_GlobalInvocationID;
    group_count[gl_LocalInvocationIndex] = 0u;
    barrier();
    if (all(lessThan(texel.xy, task.size))) {
        vec3 radiance = mean_radiance(texel);
        float brightness = max_component(radiance);
        imageStore(target, ivec3(texel), vec4(radiance, brightness));
        atomicAdd(group_count[brightness_step(brightness)], 1u);
    }
    barrier();
    uint count = group_count[gl_LocalInvocationIndex];
    if (count > 0u) atomicAdd(brightness_count[gl_LocalInvocationIndex], count);
}
