// The state of the keys. A pass or the model may ask for it; a picture that does gets the letters and digits that otherwise
// choose debug modes. The numbers of keys are those of JavaScript's keyCode, 0 to 255.
#ifndef COMMON_KEYS_GLSL
#define COMMON_KEYS_GLSL

#include "interface.glsl"

const uint KEY_BACKSPACE = 8u;
const uint KEY_TAB = 9u;
const uint KEY_ENTER = 13u;
const uint KEY_SHIFT = 16u;
const uint KEY_CTRL = 17u;
const uint KEY_ALT = 18u;
const uint KEY_PAUSE = 19u;
const uint KEY_CAPS_LOCK = 20u;
const uint KEY_ESCAPE = 27u;
const uint KEY_SPACE = 32u;
const uint KEY_PAGE_UP = 33u;
const uint KEY_PAGE_DOWN = 34u;
const uint KEY_END = 35u;
const uint KEY_HOME = 36u;
const uint KEY_LEFT = 37u;
const uint KEY_UP = 38u;
const uint KEY_RIGHT = 39u;
const uint KEY_DOWN = 40u;
const uint KEY_INSERT = 45u;
const uint KEY_DELETE = 46u;
const uint KEY_0 = 48u;
const uint KEY_1 = 49u;
const uint KEY_2 = 50u;
const uint KEY_3 = 51u;
const uint KEY_4 = 52u;
const uint KEY_5 = 53u;
const uint KEY_6 = 54u;
const uint KEY_7 = 55u;
const uint KEY_8 = 56u;
const uint KEY_9 = 57u;
const uint KEY_A = 65u;
const uint KEY_B = 66u;
const uint KEY_C = 67u;
const uint KEY_D = 68u;
const uint KEY_E = 69u;
const uint KEY_F = 70u;
const uint KEY_G = 71u;
const uint KEY_H = 72u;
const uint KEY_I = 73u;
const uint KEY_J = 74u;
const uint KEY_K = 75u;
const uint KEY_L = 76u;
const uint KEY_M = 77u;
const uint KEY_N = 78u;
const uint KEY_O = 79u;
const uint KEY_P = 80u;
const uint KEY_Q = 81u;
const uint KEY_R = 82u;
const uint KEY_S = 83u;
const uint KEY_T = 84u;
const uint KEY_U = 85u;
const uint KEY_V = 86u;
const uint KEY_W = 87u;
const uint KEY_X = 88u;
const uint KEY_Y = 89u;
const uint KEY_Z = 90u;
const uint KEY_META = 91u;
const uint KEY_NUMPAD0 = 96u;
const uint KEY_NUMPAD1 = 97u;
const uint KEY_NUMPAD2 = 98u;
const uint KEY_NUMPAD3 = 99u;
const uint KEY_NUMPAD4 = 100u;
const uint KEY_NUMPAD5 = 101u;
const uint KEY_NUMPAD6 = 102u;
const uint KEY_NUMPAD7 = 103u;
const uint KEY_NUMPAD8 = 104u;
const uint KEY_NUMPAD9 = 105u;
const uint KEY_NUMPAD_MULTIPLY = 106u;
const uint KEY_NUMPAD_ADD = 107u;
const uint KEY_NUMPAD_SUBTRACT = 109u;
const uint KEY_NUMPAD_DECIMAL = 110u;
const uint KEY_NUMPAD_DIVIDE = 111u;
const uint KEY_F1 = 112u;
const uint KEY_F2 = 113u;
const uint KEY_F3 = 114u;
const uint KEY_F4 = 115u;
const uint KEY_F5 = 116u;
const uint KEY_F6 = 117u;
const uint KEY_F7 = 118u;
const uint KEY_F8 = 119u;
const uint KEY_F9 = 120u;
const uint KEY_F10 = 121u;
const uint KEY_F11 = 122u;
const uint KEY_F12 = 123u;
const uint KEY_SEMICOLON = 186u;
const uint KEY_EQUAL = 187u;
const uint KEY_COMMA = 188u;
const uint KEY_MINUS = 189u;
const uint KEY_PERIOD = 190u;
const uint KEY_SLASH = 191u;
const uint KEY_BACKQUOTE = 192u;
const uint KEY_BRACKET_LEFT = 219u;
const uint KEY_BACKSLASH = 220u;
const uint KEY_BRACKET_RIGHT = 221u;
const uint KEY_QUOTE = 222u;

bool key_bit(uint key, uint first) {
    return key < 256u && (frame.keys[first + key / 32u] & (1u << (key % 32u))) != 0u;
}

// Whether the key is down.
bool key_down(uint key) {
    return key_bit(key, 0u);
}

// Whether the key went down since the frame before.
bool key_pressed(uint key) {
    return key_bit(key, 8u);
}

// Whether the key went down an odd number of times: each press flips it.
bool key_toggled(uint key) {
    return key_bit(key, 16u);
}

#endif
