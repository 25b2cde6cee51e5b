// The picture of a debug mode where its data does not exist.
#ifndef DEBUG_ABSENT_GLSL
#define DEBUG_ABSENT_GLSL

#include "common/color.glsl"

// Whether the mode has no data at this fragment. debug.frag and paths.frag store it as a flag beside the value.
bool no_data = false;

// `value`, or a checkerboard and the flag where the data does not exist.
vec3 if_present(bool present, vec3 value) {
    if (!present) no_data = true;
    return present ? value : checkerboard(gl_FragCoord.xy);
}

#endif
