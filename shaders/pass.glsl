// Include this in a pass of your own, a .frag or .comp file that says //@pass. A compute shader gets the block Pass alone.
//
//   //@pass vignette "Vignette" to=picture after=tonemap
//   #version 460
//   #include "pass.glsl"
//   uniform sampler2D picture;
//   void main() { color = texture(picture, uv) * (1.0 - dot(uv - 0.5, uv - 0.5)); }
//
// The picture before the tone map is linear light in cd/m^2, times coverage; its alpha also holds flags
// (common/pixel.glsl), so pass it on unchanged. After the tone map it is the displayed picture, 0..1 and sRGB-encoded.
#ifndef PASS_GLSL
#define PASS_GLSL

#include "interface.glsl"
#include "common/keys.glsl"

#ifndef COMPUTE_STAGE
// Position in this pass's image, 0..1 from the upper left corner.
layout(location = 0) in vec2 uv;
// The output of the pass.
layout(location = 0) out vec4 color;
#endif

// Properties of this pass's image.
uniform Pass {
    vec2 size_px;              // width and height, pixels
} pass;

#endif
