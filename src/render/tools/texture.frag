#version 460
#extension GL_EXT_scalar_block_layout : require

// A part of a texture with the channels that the user looks at. The display shows the numbers of the file.

layout(set = 2, binding = 0) uniform sampler2D shown;

layout(push_constant, scalar) uniform Push {
    // Corner and size of the part, in texture coordinates.
    vec2 corner;
    vec2 size;
    // Mip level; below 0, the level that fits the scale.
    float level;
    // 0: RGB. 1: RGB over a checkerboard, by alpha. 2 to 5: one of the channels R, G, B and A.
    uint channels;
    // 1: the texture is sRGB-encoded, so its colors are linear here.
    uint is_srgb;
    // Side of a square of the checkerboard, pixels.
    float square;
} push;

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;

// sRGB's encoding (IEC 61966-2-1).
vec3 encoded(vec3 linear) {
    return mix(12.92 * linear, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, greaterThan(linear, vec3(0.0031308)));
}

void main() {
    vec2 at = push.corner + uv * push.size;
    vec4 texel = push.level < 0.0 ? texture(shown, at) : textureLod(shown, at, push.level);
    vec3 rgb = push.is_srgb == 1u ? encoded(texel.rgb) : texel.rgb;
    if (push.channels == 1u) {
        vec2 cell = floor(gl_FragCoord.xy / push.square);
        float board = mod(cell.x + cell.y, 2.0) < 0.5 ? 0.25 : 0.4;
        rgb = mix(vec3(board), rgb, texel.a);
    } else if (push.channels >= 2u) {
        rgb = push.channels == 5u ? texel.aaa : rgb[push.channels - 2u].xxx;
    }
    // Outside of 0..1 the sampler repeats or clamps.
    bool is_inside = all(greaterThanEqual(at, vec2(0.0))) && all(lessThanEqual(at, vec2(1.0)));
    // The user interface encodes what it samples with this gamma.
    color = vec4(pow(is_inside ? rgb : 0.4 * rgb, vec3(2.2)), 1.0);
}
