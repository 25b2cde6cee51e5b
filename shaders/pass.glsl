// Include this in a pass of your own, a .frag file that says //@pass.
//
//   //@pass vignette "Vignette" to=picture after=tonemap
//   #version 460
//   #include "pass.glsl"
//   uniform sampler2D picture;
//   void main() { color = texture(picture, uv) * (1.0 - dot(uv - 0.5, uv - 0.5)); }
//
// The picture before the tone map is linear light in cd/m^2, times coverage; its alpha also holds flags
// (common/pixel.glsl), so give it on as it is. After the tone map it is what the display shows, 0..1 and sRGB-encoded.
#ifndef PASS_GLSL
#define PASS_GLSL

#include "interface.glsl"

// Position in this pass's image, 0..1 from the upper left corner.
layout(location = 0) in vec2 uv;
// What the pass writes.
layout(location = 0) out vec4 color;

// About this pass's image.
uniform Pass {
    vec2 size_px;              // width and height, pixels
} pass;

#endif
