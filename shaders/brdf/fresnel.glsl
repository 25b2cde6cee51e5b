// F: the part of the light that a smooth boundary reflects. It rises to 1 at grazing angles, whatever the material.
#ifndef BRDF_FRESNEL_GLSL
#define BRDF_FRESNEL_GLSL

#include "common/math.glsl"

// F = F0 + (1 - F0) (1 - VoH)^5 (Schlick 1994, eq. 15), the angle taken to the microfacet's normal h. VoH = 1 -> F0.
// Glass (index of refraction 1.5): off the full equations by at most 0.036, at 85 degrees. Metals such as aluminum dip
// before they rise; this does not.
float f_schlick(float f0, float v_dot_h) { return f0 + (1.0 - f0) * pow5(1.0 - v_dot_h); }
vec3 f_schlick(vec3 f0, float v_dot_h) { return f0 + (1.0 - f0) * pow5(1.0 - v_dot_h); }

#endif
