// Half floats, rounded here.
#ifndef IBL_HALF_GLSL
#define IBL_HALF_GLSL

const float LARGEST_HALF = 65504.0;

// The nearest half float, ties to even: 13 of a float's 23 bits of mantissa go. A store into a half-float image may as
// well cut them off, as software devices do, and a cube map would lose 0.03 % of its light with each level. What needs
// no rounding arrives unchanged. Finite values only; below 6e-5 the store rounds again.
vec3 rounded_to_half(vec3 x) {
    uvec3 bits = floatBitsToUint(min(x, LARGEST_HALF));
    return uintBitsToFloat((bits + 0xfffu + ((bits >> 13) & 1u)) & ~0x1fffu);
}

#endif
