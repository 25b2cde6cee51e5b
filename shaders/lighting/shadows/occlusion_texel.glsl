// Hidden part and distance in one float, so that one gather reads both of four texels. The float is about the hidden part, which
// is what a picture of the pass shows.
#ifndef LIGHTING_OCCLUSION_TEXEL_GLSL
#define LIGHTING_OCCLUSION_TEXEL_GLSL

#include "interface.glsl"

// The distance takes 16 bits: those of a float between 1/256 and 256 radii of the scene. unpackHalf2x16 takes longer on a software
// device.
const uint LEAST_DISTANCE = (127u - 8u) << 23;
const uint DISTANCE_SHIFT = 11u;

// `hidden`: part of the hemisphere. Its lower 16 bits give way to the distance, which leaves 1 part in 256.
float occlusion_texel(float hidden, float distance_m) {
    // Without an exponent a device may take the number, and with it the distance, for 0.
    float kept = hidden + (hidden < 0.0 ? -1e-3 : 1e-3);
    float radii = clamp(distance_m / frame.scene_radius, 1.0 / 256.0, 255.9);
    uint distance = (floatBitsToUint(radii) - LEAST_DISTANCE) >> DISTANCE_SHIFT;
    return uintBitsToFloat((floatBitsToUint(kept) & 0xffff0000u) | distance);
}

// Distances in radii of the scene.
vec4 occlusion_distances(vec4 texels) {
    return uintBitsToFloat(((floatBitsToUint(texels) & 0xffffu) << DISTANCE_SHIFT) + LEAST_DISTANCE);
}

#endif
