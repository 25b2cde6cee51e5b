#version 460
#include "interface.glsl"
#include "common/math.glsl"
#include "ibl/maps/cube_map.glsl"
#include "ibl/maps/half.glsl"
#include "ibl/small_lights/find.glsl"

// Computes one level of the cube map from the level above. Its four texels are weighted by solid angle, so a level
// keeps the light of the one above, and a texel is the mean radiance of the area it covers. (A corner texel covers a
// fifth of the solid angle of a center texel, so an unweighted mean would move light.)
//
// From level 0 to 1 small lights are removed (ibl/small_lights/list.glsl). With the last level their list is complete, and the suns
// are taken out of it.

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_TASK, binding = BINDING_LEVEL_ABOVE, rgba16f) readonly uniform image2DArray level_above;
layout(set = SET_TASK, binding = BINDING_TARGET, rgba16f) writeonly uniform image2DArray target;

const float NO_LIMIT = 1e38;

shared float limit;

// The integral of the map's radiance, at the last level. The level above it has 2 x 2 texels to a face, all of the same solid angle.
vec3 whole_light() {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 24; ++i) sum += imageLoad(level_above, ivec3(i & 1, (i >> 1) & 1, i >> 2)).rgb;
    sum *= 4.0 * PI / 24.0;
    for (uint i = 0u; i < min(found.count, LARGEST_COUNT); ++i) sum += found.lights[i].intensity;
    return sum;
}

void main() {
    if (gl_LocalInvocationIndex == 0u) limit = task.level == 1u ? brightness_limit() : NO_LIMIT;
    barrier();
    uvec3 texel = gl_GlobalInvocationID;
    if (task.separates_suns != 0u && task.level == task.levels - 1u && texel == uvec3(0u)) separate_suns(whole_light());
    if (any(greaterThanEqual(texel.xy, task.size))) return;

    float reach = 0.5 / float(task.size.x);
    vec4 kept = vec4(0.0);     // w: solid angle
    vec3 cut = vec3(0.0);
    vec3 center = vec3(0.0);   // of the removed light
    for (uint i = 0u; i < 4u; ++i) {
        uvec2 above = 2u * texel.xy + uvec2(i & 1u, i >> 1);
        vec2 st = texel_center(above, 2u * task.size);
        float steradians = solid_angle(st, reach);
        vec3 radiance = imageLoad(level_above, ivec3(above, texel.z)).rgb;
        float brightness = max_component(radiance);
        float part = brightness > limit ? limit / brightness : 1.0;
        kept += vec4(radiance * part, 1.0) * steradians;
        cut += radiance * ((1.0 - part) * steradians);
        center += normalize(cube_position(st, texel.z)) * (brightness * (1.0 - part) * steradians);
    }
    imageStore(target, ivec3(texel), vec4(rounded_to_half(kept.rgb / kept.w), 1.0));

    if (max_component(cut) > 0.0) {
        uint place = atomicAdd(found.count, 1u);
        // Variance of four points, each half a texel of level 0 from the center along both axes: 1/16 of the area.
        if (place < LARGEST_COUNT) found.lights[place] = SmallLight(normalize(center), cut, kept.w / 16.0);
    }
}
