// Numbers and small functions that everything else uses.
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

// x / |x|, or `fallback` where x has no direction. Interpolated unit vectors can cancel out, and files hold zero
// vectors; below a length of 1e-10 what is left is rounding noise. A NaN fails the comparison, so it too ends up as
// `fallback`.
vec3 safe_normalize(vec3 x, vec3 fallback) {
    float length_squared = dot(x, x);
    return length_squared > 1e-20 ? x * inversesqrt(length_squared) : fallback;
}

// sin^2 of the angle between two unit vectors. 1 - dot(a, b)^2 is the same, but of small angles leaves rounding noise
// only, since the dot is known to 6e-8; |a - b| keeps all its digits.
float sin2_between(vec3 a, vec3 b) {
    vec3 chord = a - b;
    float chord2 = dot(chord, chord);
    return chord2 * (1.0 - 0.25 * chord2);
}

// A unit vector at right angles to the unit vector n, by the axis that is farthest from n.
vec3 any_perpendicular(vec3 n) {
    return normalize(cross(n, abs(n.y) < 0.7 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0)));
}

#endif
