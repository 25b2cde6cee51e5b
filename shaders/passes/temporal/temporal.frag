//@pass temporal "Temporal antialiasing" to=picture after=ground when=TEMPORAL_ANTIALIASING doc="The mean of the last frames in place of the newest"
#version 460
#include "pass.glsl"
#include "common/pixel.glsl"
#include "passes/temporal/compress.glsl"

uniform sampler2D picture;
uniform sampler2D temporal_mean;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float alpha = texelFetch(picture, pixel, 0).a;
    vec4 mean = texelFetch(temporal_mean, pixel, 0);
    // The flags in alpha are those of the newest frame.
    color = vec4(expand(mean.rgb), alpha - coverage_of(alpha) + min(2.0 * mean.a - 1.0, 1.0));
}
