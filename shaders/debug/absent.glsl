// What a debug mode shows where its data does not exist.
#ifndef DEBUG_ABSENT_GLSL
#define DEBUG_ABSENT_GLSL

#include "common/color.glsl"

vec3 if_present(bool present, vec3 value) { return present ? value : checkerboard(gl_FragCoord.xy); }

#endif
