// Include this in a pass whose shader has Shadertoy's form: `void mainImage(out vec4 fragColor, in vec2 fragCoord)`.
// `specula FILE.glsl` makes such a pass of any file. With TOY_MAIN it serves files of glslViewer's form, whose main is called
// Main here.
//
// It includes nothing, so that a shader may use any name, as Light or material. Rows count from below, as in OpenGL: Specula's
// images have their first row on top, so that of a pass with TOY_BUFFER, which only toys read, is upside down.
#ifndef TOY_GLSL
#define TOY_GLSL

layout(location = 0) in vec2 toy_uv;
layout(location = 0) out vec4 toy_color;

uniform Pass {
    vec2 size_px;
    vec4 mouse_px;
    vec4 date;
    float time_s;
    float delta_s;
    uint frame_index;
} toy;

#ifdef TOY_FILE
// The stage of a file gives these values their names, except names that the file declares itself.
#define iResolution toy_iResolution
#define iTime toy_iTime
#define iTimeDelta toy_iTimeDelta
#define iFrameRate toy_iFrameRate
#define iFrame toy_iFrame
#define iMouse toy_iMouse
#define iDate toy_iDate
#define iChannelTime toy_iChannelTime
#define iSampleRate toy_iSampleRate
#endif

vec3 iResolution;              // width and height, pixels; 1
float iTime;                   // seconds
float iTimeDelta;              // seconds since the frame before
float iFrameRate;              // frames a second
int iFrame;                    // frames before this one
vec4 iMouse;                   // xy: last place of the mouse while it was down; zw: where it went down, z < 0 once it is up, w < 0 after the first frame
vec4 iDate;                    // year, month from 0, day from 1, seconds of the day
float iChannelTime[4];
const float iSampleRate = 44100.0;

#ifndef TOY_FILE
// The same under the names of glslViewer and the Book of Shaders, and of Shadertoy's first years.
#define u_time iTime
#define u_delta iTimeDelta
#define u_frame iFrame
#define u_date iDate
#define u_resolution (iResolution.xy)
#define u_mouse (iMouse.xy)
#define v_texcoord (toyFragCoord.xy / iResolution.xy)
#define iGlobalTime iTime
#endif

// Names of GLSL ES 1.00.
#define texture2D texture
#define textureCube texture
#define texture2DProj textureProj
#define texture2DLod textureLod
#define texture2DLodEXT textureLod
#define textureCubeLodEXT textureLod
#define texture2DGradEXT textureGrad
#define gl_FragDepthEXT gl_FragDepth

#ifdef TOY_FILE
// The first two are types in Vulkan's GLSL. A file may define them as functions, so they have other names in it.
#define texture2_ texture
#define textureCub_ texture
#define toyES 1
#define HW_PERFORMANCE 1
// Precisions mean nothing here, and must not tell two declarations of a function apart.
#define lowp
#define mediump
#define highp
// The argument of a macro that is called with none.
#define toy_nothing
#endif

// gl_FragCoord and gl_FragColor of the file.
vec4 toyFragCoord;
vec4 toyFragColor;
// The image is a triangle whose front is visible in WebGL.
const bool toyFrontFacing = true;

void toy_begin() {
    iResolution = vec3(toy.size_px, 1.0);
    iTime = toy.time_s;
    iTimeDelta = toy.delta_s;
    // The first frame follows none.
    iFrameRate = toy.delta_s > 0.0 ? 1.0 / toy.delta_s : 60.0;
    iFrame = int(toy.frame_index);
    vec4 mouse = toy.mouse_px;
    bool was_down = mouse != vec4(0.0);
    float from_y = toy.size_px.y - abs(mouse.w);
    iMouse = was_down ? vec4(mouse.x, toy.size_px.y - mouse.y, mouse.z, mouse.w < 0.0 ? -from_y : from_y) : vec4(0.0);
    iDate = toy.date;
    iChannelTime = float[4](iTime, iTime, iTime, iTime);
    toyFragCoord = gl_FragCoord;
    toyFragColor = vec4(0.0, 0.0, 0.0, 1.0);
#ifndef TOY_BUFFER
    toyFragCoord.y = toy.size_px.y - gl_FragCoord.y;
#endif
}

void toy_end() {
    toy_color = toyFragColor;
#ifndef TOY_BUFFER
    toy_color.a = 1.0;
#endif
}

// `specula check` compiles this file alone, in a stage that has its own main and no mainImage.
#ifndef LIBRARY_ALONE
#ifdef TOY_MAIN
void Main();
#else
void mainImage(out vec4 fragColor, in vec2 fragCoord);
void Main() { mainImage(toyFragColor, toyFragCoord.xy); }
#endif

#ifdef TOY_FILE
void toy_variables();
#endif

void main() {
    toy_begin();
#ifdef TOY_FILE
    toy_variables();
#endif
    Main();
    toy_end();
}
#endif

#ifdef TOY_FILE
#undef iResolution
#undef iTime
#undef iTimeDelta
#undef iFrameRate
#undef iFrame
#undef iMouse
#undef iDate
#undef iChannelTime
#undef iSampleRate
#endif

#endif
