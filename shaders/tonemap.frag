//@pass tonemap "Tone map" to=display doc="Exposure, tone map and encoding: scene color to the picture"
#version 460
#include "interface.glsl"
#include "common/bloom.glsl"
#include "common/color.glsl"
#include "common/pixel.glsl"
#include "common/range.glsl"
#include "common/tonemap.glsl"
#include "user/display.glsl"

// From scene color to the picture: exposure, tone map, background, encoding. The target stores numbers as they are
// (UNORM), so the sRGB curve is applied here. Alpha leaves straight, not premultiplied.

uniform sampler2D picture;

layout(location = 0) out vec4 out_color;

// The display's color for `value`, 0..1 and still linear if it is a color. Light is exposed. `uv`: 0..1 in the picture.
vec3 display_value(vec3 value, vec2 uv) {
    if (TONEMAP != TONEMAP_OFF) value = tonemap(user_display(value, uv), TONEMAP);
    if (ENCODE == ENCODE_VECTOR) value = value * 0.5 + 0.5;
    return saturate(value);
}

void main() {
    vec4 scene = texelFetch(picture, ivec2(gl_FragCoord.xy - frame.viewport_origin_px), 0);
    // The image of a pass may have anything in alpha.
    bool is_pass = TONEMAP == TONEMAP_OFF && frame.mode >= PASS_MODES;
    float coverage = is_pass ? 1.0 : coverage_of(scene.a);
    // Where there is no value, the picture says so in colors of its own.
    bool has_value = is_pass || scene.a < 2.0;
    // A constant: a software device would compute both sides of a branch on a uniform.
    bool is_mapped = MAPS_VALUES != 0u && has_value;
    bool ranged = is_mapped && has_range();
    vec2 uv = (gl_FragCoord.xy - frame.viewport_origin_px) / frame.viewport_px;
    vec3 value = scene.rgb;
    if (TONEMAP != TONEMAP_OFF && !ranged) {
        value *= frame.exposure;
        if (BLOOM) add_bloom(value, coverage, uv);
    }
    // The curves are not linear, so they want the color of the surface, not the color times how much of it there is. 1e-6:
    // where nothing covers the pixel, the color is 0.
    value /= max(coverage, 1e-6);
    vec3 front = ranged ? saturate(in_range(value)) : display_value(value, uv);
    // Most curves would make this magenta white.
    if (is_cut_short(scene)) front = vec3(1.0, 0.0, 1.0);
    if (is_mapped) {
        front = chosen_channels(front, is_pass ? saturate(scene.a) : coverage);
        if (frame.has_colormap != 0u) {
            front = color_of_number(front.x);
            if (ENCODE != ENCODE_COLOR) front = srgb_from_linear(front);
        }
    }

    // Colors meet in linear light, as they do in a lens. Numbers have no such space: they meet the encoded background.
    vec3 back = ENCODE == ENCODE_COLOR ? frame.background.rgb : srgb_from_linear(frame.background.rgb);

    // A over B (Porter & Duff 1984), divided by its alpha: the mean of both colors.
    float alpha = mix(frame.background.a, 1.0, coverage);
    vec3 color = mix(back, front, coverage / max(alpha, 1e-6));
    if (ENCODE == ENCODE_COLOR) color = srgb_from_linear(color);
    // Not on a plain background, which has no bands. A device compresses equal pixels.
    if (TONEMAP != TONEMAP_OFF) color += coverage * dither_noise(gl_FragCoord.xy - frame.viewport_origin_px);
    out_color = vec4(color, alpha);
}
