// Shows the image of a toy that reads its own image of the previous frame, whose rows count from below.
#ifndef TOY_SHOWN_GLSL
#define TOY_SHOWN_GLSL

uniform sampler2D image;

vec4 shown_texel(ivec2 place) {
    ivec2 size = textureSize(image, 0);
    return vec4(texelFetch(image, ivec2(place.x, size.y - 1 - place.y), 0).rgb, 1.0);
}

#ifndef LIBRARY_ALONE
layout(location = 0) out vec4 color;

void main() {
    color = shown_texel(ivec2(gl_FragCoord.xy));
}
#endif

#endif
