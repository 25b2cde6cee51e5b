// Packs the hidden part of the hemisphere and the distance into one float, so that one gather reads both from four texels. Read as a
// number, the float is the hidden part, up to 1 %, so a picture of the pass needs no unpacking.
#ifndef LIGHTING_OCCLUSION_TEXEL_GLSL
#define LIGHTING_OCCLUSION_TEXEL_GLSL

#include "interface.glsl"

// The distance has 4 bits of exponent and 12 of mantissa: 1/256 to 256 radii of the scene. Surfaces beyond these limits count as equally
// far. unpackHalf2x16 takes longer on a software device.
const uint LEAST_DISTANCE = (127u - 8u) << 23;
const uint DISTANCE_SHIFT = 11u;

// `hidden`: part of the hemisphere, which keeps 7 bits of its mantissa. `radii`: distance in radii of the scene. A packed surface is never
// 0, so 0 means that there is none.
float pack_occlusion(float hidden, float radii) {
    // A device may flush a number without an exponent, and the distance with it.
    float kept = hidden < 0.0 ? min(hidden, -1e-3) : max(hidden, 1e-3);
    uint distance = (floatBitsToUint(clamp(radii, 1.0 / 256.0, 255.9)) - LEAST_DISTANCE) >> DISTANCE_SHIFT;
    return uintBitsToFloat((floatBitsToUint(kept) & 0xffff0000u) | distance);
}

// Distances in radii of the scene; 1/256 where there is no surface.
vec4 unpack_radii(vec4 texels) {
    return uintBitsToFloat(((floatBitsToUint(texels) & 0xffffu) << DISTANCE_SHIFT) + LEAST_DISTANCE);
}

#endif
