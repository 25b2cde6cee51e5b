//@pass lut "Color table" to=picture after=outline off doc="Grades the displayed picture with a .cube file"
//@texture color_table "warm.cube" linear clamp
#version 460
#include "pass.glsl"

// Grading by a 3-D lookup table (Selan 2005, GPU Gems 2, chapter 24, "Using Lookup Tables to Accelerate Color
// Transformations"). Programs for color grading export such .cube files: put yours beside this one, and its name above. The table maps what the display shows, sRGB-encoded 0..1. Its slices of equal blue lie side by side in the image.
//
// Limits: it grades what the display can show, so it brings back nothing beyond white. DOMAIN_MIN and DOMAIN_MAX must be 0 and 1. Between
// the entries colors are mixed along the axes, which dulls grays of coarse tables a little.

uniform sampler2D picture;
uniform sampler2D color_table;

uniform Lut {
    float lut_strength;        //@ui "Color table" 0..1 = 1
};

// The color in slice `blue`, whole; red and green are blended by the sampler. Centers of texels are half a texel inside.
vec3 in_slice(vec2 red_green, float blue, float size) {
    vec2 texel = red_green * (size - 1.0) + 0.5;
    return textureLod(color_table, vec2(texel.x + blue * size, texel.y) / vec2(size * size, size), 0.0).rgb;
}

void main() {
    vec4 scene = texture(picture, uv);
    float size = float(textureSize(color_table, 0).y);
    vec3 c = clamp(scene.rgb, 0.0, 1.0);
    float blue = c.b * (size - 1.0);
    float low = min(floor(blue), size - 2.0);
    vec3 graded = mix(in_slice(c.rg, low, size), in_slice(c.rg, low + 1.0, size), blue - low);
    color = vec4(mix(scene.rgb, graded, lut_strength), scene.a);
}
