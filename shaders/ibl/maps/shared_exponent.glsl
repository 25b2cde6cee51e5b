// Radiance in 32 bits a texel: E5B9G9R9, three mantissas of 9 bits with one exponent (Vulkan 1.3, section "RGB to shared
// exponent"). A channel is off by at most 1/511 of the largest. Shaders cannot write this format, so a task writes words to a
// buffer, which is then copied to the image.
#ifndef IBL_MAPS_SHARED_EXPONENT_GLSL
#define IBL_MAPS_SHARED_EXPONENT_GLSL

#include "interface.glsl"
#include "common/math.glsl"

layout(set = SET_TASK, binding = BINDING_PACKED, scalar) writeonly buffer Packed { uint packed_texels[]; };

// 511/512 of 2^16: the largest mantissa with the largest exponent.
const float LARGEST_SHARED = 65408.0;
// The exponent's offset, 15, plus the 9 bits of a mantissa: a channel is mantissa * 2^(exponent - 24).
const uint EXPONENT_BIAS = 24u;

// Negative values, negative zero and NaN become 0. (No comparison with NaN holds.)
uint shared_exponent(vec3 radiance) {
    vec3 rgb = mix(vec3(0.0), min(radiance, LARGEST_SHARED), greaterThan(radiance, vec3(0.0)));
    // The exponent of the largest channel once that is rounded to 9 bits: 0x4000 is half of the last of them. A float has an
    // exponent of 111 where this format's is 0; smaller values have fewer digits.
    int exponent = int((floatBitsToUint(max_component(rgb)) + 0x4000u) >> 23) - 111;
    uint shared_bits = uint(max(exponent, 0));
    float scale = uintBitsToFloat((127u + EXPONENT_BIAS - shared_bits) << 23);
    uvec3 mantissa = uvec3(rgb * scale + 0.5);
    return shared_bits << 27 | mantissa.b << 18 | mantissa.g << 9 | mantissa.r;
}

// Writes a texel of an image of this width.
void store_texel(ivec2 texel, uint width, vec3 radiance) {
    packed_texels[uint(texel.y) * width + uint(texel.x)] = shared_exponent(radiance);
}

#endif
