//@pass hatching "Hatching" to=picture after=tonemap doc="The picture as a drawing in ink: strokes by its light, lines where the normal turns"
#version 460
#include "pass.glsl"
#include "common/color.glsl"
#include "common/math.glsl"

// Strokes in four directions, of which the darker a place is, the more are drawn (after Praun, Hoppe, Webb & Finkelstein 2001,
// "Real-Time Hatching"; here the strokes lie in the picture, not on the surface).

uniform sampler2D picture;
uniform sampler2D normals;

uniform Hatching {
    float hatching_width;      //@ui "Distance of strokes, pixels" 3..20 = 7
    vec3 hatching_ink;         //@ui "Ink" color = 0.05 0.05 0.12
    vec3 hatching_paper;       //@ui "Paper" color = 0.95 0.92 0.85
};

// 1 on a stroke: a line every `hatching_width` pixels across this direction, wider where it is dark.
float stroke(float angle, float dark) {
    vec2 across = vec2(cos(angle), sin(angle));
    float along = dot(gl_FragCoord.xy, vec2(-across.y, across.x));
    float wobble = 0.8 * sin(0.07 * along + 3.0 * angle);
    float from_center = abs(fract((dot(gl_FragCoord.xy, across) + wobble) / hatching_width) - 0.5);
    return smoothstep(0.5 - 0.45 * dark, 0.5 - 0.45 * dark + 1.5 / hatching_width, from_center) * step(0.02, dark);
}

// How much the normals of neighboring pixels differ.
float edge() {
    ivec2 at = clamp(ivec2(gl_FragCoord.xy), ivec2(1), textureSize(normals, 0) - 2);
    vec4 x = texelFetch(normals, at + ivec2(1, 0), 0) - texelFetch(normals, at - ivec2(1, 0), 0);
    vec4 y = texelFetch(normals, at + ivec2(0, 1), 0) - texelFetch(normals, at - ivec2(0, 1), 0);
    return smoothstep(0.3, 0.8, length(vec2(length(x), length(y))));
}

void main() {
    vec4 scene = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
    bool is_model = texelFetch(normals, ivec2(gl_FragCoord.xy), 0).a > 0.0;
    float dark = is_model ? 1.0 - luminance(scene.rgb) : 0.0;
    float ink = edge();
    for (int i = 0; i < 4; ++i) ink = max(ink, stroke(0.6 + 0.7 * float(i), saturate(2.0 * dark - 0.45 * float(i))));
    color = vec4(srgb_from_linear(mix(hatching_paper, hatching_ink, ink)), 1.0);
}
