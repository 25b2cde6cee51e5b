// Constants and small functions that all shaders share.
#ifndef COMMON_MATH_GLSL
#define COMMON_MATH_GLSL

const float PI = 3.14159265358979;

float saturate(float x) { return clamp(x, 0.0, 1.0); }
vec3 saturate(vec3 x) { return clamp(x, 0.0, 1.0); }

float pow5(float x) {
    float x2 = x * x;
    return x2 * x2 * x;
}

float max_component(vec3 x) { return max(x.r, max(x.g, x.b)); }
float min_component(vec3 x) { return min(x.r, min(x.g, x.b)); }

// x / |x|, or `fallback` for |x| below 1e-10. Interpolated unit vectors can cancel out, files contain zero vectors, and
// below that length only rounding noise is left. A NaN fails the comparison, so it yields `fallback` too.
vec3 safe_normalize(vec3 x, vec3 fallback) {
    float length_squared = dot(x, x);
    return length_squared > 1e-20 ? x * inversesqrt(length_squared) : fallback;
}

// Whether two values have the same bits. Unlike ==, this is true for two equal NaNs. So the driver's optimizer knows the answer
// where nothing can have changed a value.
bool is_same_bits(float a, float b) { return floatBitsToUint(a) == floatBitsToUint(b); }
bool is_same_bits(vec3 a, vec3 b) { return all(equal(floatBitsToUint(a), floatBitsToUint(b))); }

// sin^2 of the angle between two unit vectors. 1 - dot(a, b)^2 is equal in theory, but the dot product has an error of
// 6e-8, which swamps small angles. |a - b| keeps full precision.
float sin2_between(vec3 a, vec3 b) {
    vec3 chord = a - b;
    float chord2 = dot(chord, chord);
    return chord2 * (1.0 - 0.25 * chord2);
}

// x, mirrored at the plane of n if it points below it: x - 2 min(n . x, 0) n. n . x becomes |n . x|.
vec3 mirrored_to_front(vec3 n, vec3 x) { return x - 2.0 * min(dot(n, x), 0.0) * n; }

// A unit vector perpendicular to the unit vector n.
vec3 any_perpendicular(vec3 n) {
    return normalize(cross(n, abs(n.y) < 0.7 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0)));
}

#endif
