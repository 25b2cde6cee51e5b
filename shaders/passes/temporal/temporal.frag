//@pass temporal "Temporal antialiasing" to=picture when=TEMPORAL_ANTIALIASING doc="The mean of the last frames in place of the newest"
#version 460
#include "pass.glsl"
#include "common/pixel.glsl"
#include "passes/temporal/compress.glsl"

// Shows the mean of temporal_mean.frag, which has source and limits.

uniform sampler2D picture;
uniform sampler2D temporal_mean;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 newest = texelFetch(picture, pixel, 0);
    vec4 mean = texelFetch(temporal_mean, pixel, 0);
    // The other pass is off.
    color = newest;
    if (mean.a == 0.0) return;
    // The flags in alpha are those of the newest frame.
    color = vec4(expand(mean.rgb), newest.a - coverage_of(newest.a) + min(2.0 * mean.a - 1.0, 1.0));
}
