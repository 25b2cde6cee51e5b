//@pass dof_light "Depth of field: light" size=1/2 format=rgba32f doc="Light times coverage at half the size; in alpha, coverage and blur"
#version 460
#include "pass.glsl"
#include "lens.glsl"

// The mean of those of four pixels that are as blurred as the first one. The others belong to another surface.

uniform sampler2D picture;
uniform sampler2D dof_circle;

void main() {
    ivec2 first = 2 * ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(dof_circle, 0) - 1;
    float here = texelFetch(dof_circle, first, 0).r;
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 pixel = min(first + ivec2(i & 1, i >> 1), last);
        float weight = clamp(2.0 - abs(texelFetch(dof_circle, pixel, 0).r - here), 0.0, 1.0);
        vec4 scene = texelFetch(picture, pixel, 0);
        sum += weight * vec4(scene.rgb, coverage_of(scene.a));
        weights += weight;
    }
    color = lens_texel(sum / weights, here);
}
