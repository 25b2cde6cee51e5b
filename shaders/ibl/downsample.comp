#version 460
#include "interface.glsl"
#include "common/math.glsl"
#include "ibl/cube_map.glsl"
#include "ibl/half.glsl"
#include "ibl/small_lights.glsl"

// One level of the cube map from the level above it. Each of the four texels counts by its solid angle: so a level
// holds as much light as the one above, and a texel's value is the mean radiance of what it covers. (In a corner of a
// face a texel covers a fifth of one at the center, so an even mean would move light about.)
//
// From level 0 to 1, small lights are taken out: see ibl/small_lights.glsl. Alpha still tells of them: it is the largest.

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_TASK, binding = BINDING_LEVEL_ABOVE, rgba16f) readonly uniform image2DArray level_above;
layout(set = SET_TASK, binding = BINDING_TARGET, rgba16f) writeonly uniform image2DArray target;

const float NO_LIMIT = 1e38;

shared float limit;

void main() {
    if (gl_LocalInvocationIndex == 0u) limit = task.level == 1u ? brightness_limit() : NO_LIMIT;
    barrier();
    uvec3 texel = gl_GlobalInvocationID;
    if (any(greaterThanEqual(texel.xy, task.size))) return;

    float reach = 0.5 / float(task.size.x);
    vec4 kept = vec4(0.0);     // w: of the solid angles
    float brightest = 0.0;
    vec3 cut = vec3(0.0);
    vec3 center = vec3(0.0);   // of what was cut
    for (uint i = 0u; i < 4u; ++i) {
        uvec2 above = 2u * texel.xy + uvec2(i & 1u, i >> 1);
        vec2 st = texel_center(above, 2u * task.size);
        float steradians = solid_angle(st, reach);
        vec4 texel_above = imageLoad(level_above, ivec3(above, texel.z));
        vec3 radiance = texel_above.rgb;
        brightest = max(brightest, texel_above.a);
        float brightness = max_component(radiance);
        float part = brightness > limit ? limit / brightness : 1.0;
        kept += vec4(radiance * part, 1.0) * steradians;
        cut += radiance * ((1.0 - part) * steradians);
        center += normalize(cube_position(st, texel.z)) * (brightness * (1.0 - part) * steradians);
    }
    imageStore(target, ivec3(texel), vec4(rounded_to_half(kept.rgb / kept.w), brightest));

    if (max_component(cut) > 0.0) {
        uint place = atomicAdd(small_light_count, 1u);
        // Four points half a texel of level 0 from their center, along both axes: a sixteenth of the area.
        if (place < LARGEST_COUNT) small_lights[place] = SmallLight(normalize(center), cut, kept.w / 16.0);
    }
}
