// The hook into the tone mapping pass. By default it changes nothing.
#ifndef USER_DISPLAY_GLSL
#define USER_DISPLAY_GLSL

#include "interface.glsl"
#include "user/params.glsl"

// Exposed light before the tone map: linear RGB, 1 is the sensor's saturation at this EV. Grade the picture here, where
// light still adds up; after the tone map, bright colors would already be compressed. With `--tonemap none`, which only
// clips at 1, this hook can be a tone map of your own. `uv`: position in the picture, 0..1 from the upper left corner.
//
// Modes that show data, and a background color, do not pass through.
vec3 user_display(vec3 light, vec2 uv) {
    return light;
}

#endif
