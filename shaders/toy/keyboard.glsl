// Shadertoy's keyboard, an image of 256 x 3 texels. Column: the number of the key. Row 0: it is down; row 1: it went down in this
// frame; row 2: it went down an odd number of times. `specula FILE.glsl` makes a pass of this for a channel "keyboard".
#ifndef TOY_KEYBOARD_GLSL
#define TOY_KEYBOARD_GLSL

#include "common/keys.glsl"

vec4 keyboard_texel(uint key, uint row) {
    bool is_set = row == 0u ? key_down(key) : row == 1u ? key_pressed(key) : key_toggled(key);
    return vec4(is_set ? 1.0 : 0.0, 0.0, 0.0, 1.0);
}

#ifndef LIBRARY_ALONE
layout(location = 0) out vec4 color;

void main() {
    color = keyboard_texel(uint(gl_FragCoord.x), uint(gl_FragCoord.y));
}
#endif

#endif
