//@pass dof_near_raw "Depth of field: foreground samples" size=1/2 doc="Blurred light of what is in front of the focus, times its opacity, and opacity; with noise"
#version 460
#include "pass.glsl"
#include "lens.glsl"

uniform sampler2D dof_soft;
uniform sampler2D dof_reach;

void main() {
    ivec2 last = textureSize(dof_soft, 0) - 1;
    float radius = texelFetch(dof_reach, ivec2(gl_FragCoord.xy) / 8, 0).r;
    vec2 direction = first_direction(gl_FragCoord.xy);
    // Without blur the loop takes no turn.
    int samples = radius < 0.5 ? 0 : LENS_SAMPLES;
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < samples; ++i) {
        direction = GOLDEN_TURN * direction;
        vec2 disk = lens_sample(i);
        float away = disk.x * radius;
        ivec2 texel = clamp(ivec2(gl_FragCoord.xy + 0.5 * away * direction), ivec2(0), last);
        vec4 sampled = texelFetch(dof_soft, texel, 0);
        float blur = -blur_of(sampled);
        // Each point covers the part of its circle that this sample's area is.
        float covers = disk.y * radius * radius / max(blur * blur, 1.0);
        float weight = covers * reach(blur, away) * smoothstep(0.5, 1.5, blur);
        sum += weight * light_of(sampled);
        weights += weight;
    }
    color = sum / max(weights, 1.0);
}
