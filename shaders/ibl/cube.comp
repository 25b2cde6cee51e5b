#version 460
#include "interface.glsl"
#include "common/math.glsl"
#include "ibl/maps/cube_map.glsl"
#include "ibl/maps/half.glsl"
#include "ibl/small_lights/find.glsl"

// Converts an equirectangular image to level 0 of a cube map. One invocation per texel; z is the face.
//
// The image's center column is seen looking down -Z; columns to its right are towards +X:
// u = 0.5 + atan(x, -z) / 2 pi, v = acos(y) / pi.

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_TASK, binding = BINDING_SOURCE) uniform sampler2D source;
layout(set = SET_TASK, binding = BINDING_TARGET, rgba16f) writeonly uniform image2DArray target;

// An arctangent replaces acos(y), which loses half its digits near the poles. u = 0 and u = 1 are the same column: the
// sampler repeats, and the explicit level avoids a derivative across the seam.
vec3 radiance_from(vec3 d) {
    vec2 uv = vec2(0.5 + atan(d.x, -d.z) / (2.0 * PI), atan(length(d.xz), d.y) / PI);
    return textureLod(source, uv, 0.0).rgb;
}

// The mean over task.samples x task.samples points, so that features smaller than a texel, such as a sun, keep their
// energy. Within one texel, all points have nearly the same solid angle.
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

// Counts per workgroup first: a single global counter for all texels would serialize the atomics.
shared uint group_count[BRIGHTNESS_STEPS];

void main() {
    uvec3 texel = gl_GlobalInvocationID;
    group_count[gl_LocalInvocationIndex] = 0u;
    barrier();
    if (all(lessThan(texel.xy, task.size))) {
        vec3 radiance = mean_radiance(texel);
        float brightness = max_component(radiance);
        imageStore(target, ivec3(texel), vec4(radiance, 1.0));
        atomicAdd(group_count[brightness_step(brightness)], 1u);
    }
    barrier();
    uint count = group_count[gl_LocalInvocationIndex];
    if (count > 0u) atomicAdd(found.brightness_count[gl_LocalInvocationIndex], count);
}
