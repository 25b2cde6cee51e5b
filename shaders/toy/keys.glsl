// Functions that read the keyboard, and the numbers of keys. A line `#iKeyboard` in a file of Shadertoy's form declares them. The
// names are those of the Shader Toy extension of VS Code.
#ifndef TOY_KEYS_GLSL
#define TOY_KEYS_GLSL

// `specula check` compiles this file alone. A stage declares the keyboard itself.
#ifdef LIBRARY_ALONE
uniform sampler2D toy_keyboard;
#endif

const int Key_Backspace = 8;
const int Key_Tab = 9;
const int Key_Enter = 13;
const int Key_Shift = 16;
const int Key_Ctrl = 17;
const int Key_Alt = 18;
const int Key_Pause = 19;
const int Key_Caps = 20;
const int Key_Escape = 27;
const int Key_PageUp = 33;
const int Key_PageDown = 34;
const int Key_End = 35;
const int Key_Home = 36;
const int Key_LeftArrow = 37;
const int Key_UpArrow = 38;
const int Key_RightArrow = 39;
const int Key_DownArrow = 40;
const int Key_Insert = 45;
const int Key_Delete = 46;
const int Key_0 = 48;
const int Key_1 = 49;
const int Key_2 = 50;
const int Key_3 = 51;
const int Key_4 = 52;
const int Key_5 = 53;
const int Key_6 = 54;
const int Key_7 = 55;
const int Key_8 = 56;
const int Key_9 = 57;
const int Key_A = 65;
const int Key_B = 66;
const int Key_C = 67;
const int Key_D = 68;
const int Key_E = 69;
const int Key_F = 70;
const int Key_G = 71;
const int Key_H = 72;
const int Key_I = 73;
const int Key_J = 74;
const int Key_K = 75;
const int Key_L = 76;
const int Key_M = 77;
const int Key_N = 78;
const int Key_O = 79;
const int Key_P = 80;
const int Key_Q = 81;
const int Key_R = 82;
const int Key_S = 83;
const int Key_T = 84;
const int Key_U = 85;
const int Key_V = 86;
const int Key_W = 87;
const int Key_X = 88;
const int Key_Y = 89;
const int Key_Z = 90;
const int Key_LeftWindow = 91;
const int Key_Numpad0 = 96;
const int Key_Numpad1 = 97;
const int Key_Numpad2 = 98;
const int Key_Numpad3 = 99;
const int Key_Numpad4 = 100;
const int Key_Numpad5 = 101;
const int Key_Numpad6 = 102;
const int Key_Numpad7 = 103;
const int Key_Numpad8 = 104;
const int Key_Numpad9 = 105;
const int Key_NumpadMultiply = 106;
const int Key_NumpadAdd = 107;
const int Key_NumpadSubtract = 109;
const int Key_NumpadPeriod = 110;
const int Key_NumpadDivide = 111;
const int Key_F1 = 112;
const int Key_F2 = 113;
const int Key_F3 = 114;
const int Key_F4 = 115;
const int Key_F5 = 116;
const int Key_F6 = 117;
const int Key_F7 = 118;
const int Key_F8 = 119;
const int Key_F9 = 120;
const int Key_F10 = 121;
const int Key_F11 = 122;
const int Key_F12 = 123;
const int Key_SemiColon = 186;
const int Key_Equal = 187;
const int Key_Comma = 188;
const int Key_Dash = 189;
const int Key_Period = 190;
const int Key_ForwardSlash = 191;
const int Key_GraveAccent = 192;
const int Key_OpenBracket = 219;
const int Key_BackSlash = 220;
const int Key_CloseBraket = 221;
const int Key_SingleQuote = 222;

bool isKeyDown(int key) { return texelFetch(toy_keyboard, ivec2(key, 0), 0).x > 0.5; }
bool isKeyPressed(int key) { return texelFetch(toy_keyboard, ivec2(key, 1), 0).x > 0.5; }
bool isKeyToggled(int key) { return texelFetch(toy_keyboard, ivec2(key, 2), 0).x > 0.5; }

#endif
