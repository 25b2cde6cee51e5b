#version 460
#include "interface.glsl"
#include "ibl/cube_map.glsl"
#include "ibl/half.glsl"

// One level of the cube map from the level above it: 4 x 4 texels with the weights 1 3 3 1 along both axes.
//
// Each texel above then counts 3/4 for the texel below that it lies in and 1/4 for the next one, as far as it is from their
// centers: the center of gravity of its light stays in place. An even mean of 2 x 2 would pull a sun into the center of
// whatever texel it is in, and with it the highlights of everything rough, by half a texel at worst: with small suns that was
// nine tenths of the prefilter's error. The weights are also those of the solid angles: a level holds as much light
// as the one above, though in a corner of a face a texel covers a fifth of one at the center.

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_TASK, binding = BINDING_LEVEL_ABOVE, rgba16f) readonly uniform image2DArray level_above;
layout(set = SET_TASK, binding = BINDING_TARGET, rgba16f) writeonly uniform image2DArray target;

void main() {
    uvec3 texel = gl_GlobalInvocationID;
    if (any(greaterThanEqual(texel.xy, task.size))) return;

    int side = 2 * int(task.size.x);
    vec4 sum = vec4(0.0);      // w: of the weights
    for (int y = -1; y < 3; ++y) {
        for (int x = -1; x < 3; ++x) {
            ivec2 at = 2 * ivec2(texel.xy) + ivec2(x, y);
            bvec2 beyond = greaterThanEqual(uvec2(at), uvec2(side));   // -1 is large, too
            if (all(beyond)) continue;   // three faces meet: there is no texel
            ivec3 above = ivec3(at, texel.z);
            if (any(beyond)) above = texel_across_edge(above, side);
            float weight = (x == 0 || x == 1 ? 3.0 : 1.0) * (y == 0 || y == 1 ? 3.0 : 1.0);
            weight *= solid_angle_density(texel_center(uvec2(above.xy), uvec2(side)));
            sum += vec4(imageLoad(level_above, above).rgb, 1.0) * weight;
        }
    }
    imageStore(target, ivec3(texel), vec4(rounded_to_half(sum.rgb / sum.w), 1.0));
}
