#version 460
#include "interface.glsl"
#include "common/math.glsl"
#include "ibl/maps/cube_map.glsl"
#include "ibl/maps/octahedral.glsl"
#include "ibl/maps/shared_exponent.glsl"
#include "ibl/small_lights/add.glsl"

// Diffuse light from the environment: the radiance that a white Lambertian surface with the normal n reflects,
//
//   E(n) / pi = integral of L max(n . l, 0) dl / pi
//
// summed over all texels of one level of the cube map. That level must have at least 16 x 16 texels a face, so that
// a texel is small against the cosine. Dividing by the sum of the weights instead of by pi keeps constant light exact.

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_TASK, binding = BINDING_LEVEL_ABOVE, rgba16f) readonly uniform image2DArray source;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (!contains(irradiance_tile(), texel)) return;
    vec3 n = octahedral_direction(point_of_texel(texel, irradiance_tile()));

    uint side = uint(imageSize(source).x);
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < 6u * side * side; ++i) {
        uvec3 from = uvec3(i % side, i / side % side, i / (side * side));
        vec3 d = cube_position(texel_center(from.xy, uvec2(side)), from.z);
        // n . l = n . d / |d|, and the texel's solid angle is proportional to |d|^-3.
        float squared = dot(d, d);
        float weight = max(dot(n, d), 0.0) / (squared * squared);
        sum += vec4(imageLoad(source, ivec3(from)).rgb, 1.0) * weight;
    }
    vec3 radiance = sum.rgb / sum.w;

    // Adds the small lights but the suns. The levels below 0 do not have them.
    for (uint i = 0u; i < listed_lights(); ++i) {
        radiance += listed.lights[i].intensity * (max(dot(n, listed.lights[i].direction), 0.0) / PI);
    }
    store_texel(texel, IRRADIANCE_SIDE, radiance);
}
