// Rounding to half floats.
#ifndef IBL_MAPS_HALF_GLSL
#define IBL_MAPS_HALF_GLSL

const float LARGEST_HALF = 65504.0;

// Rounds to the nearest half float, ties to even, by dropping 13 of a float's 23 mantissa bits. A store to a half-float
// image may truncate instead, as software devices do; a cube map would lose 0.03 % of its light per level. Values that
// a half holds exactly do not change. Finite values only; below 6e-5 the store rounds again.
vec3 rounded_to_half(vec3 x) {
    uvec3 bits = floatBitsToUint(min(x, LARGEST_HALF));
    return uintBitsToFloat((bits + 0xfffu + ((bits >> 13) & 1u)) & ~0x1fffu);
}

vec4 rounded_to_half(vec4 x) { return vec4(rounded_to_half(x.rgb), rounded_to_half(x.aaa).x); }

#endif
