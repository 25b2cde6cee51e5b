//@pass resolve "Resolve" to=resolve doc="One color from the samples of a pixel, where the picture is multisampled and tone mapped"
#version 460
#include "interface.glsl"
#include "common/math.glsl"
#include "common/pixel.glsl"

// The mean of a pixel's samples, each weighed by w = 1 / (1 + its largest exposed channel) (Karis 2014, "High Quality Temporal
// Supersampling"; Pettineo 2015, "A Quick Overview of MSAA"). A plain mean belongs after the tone map, which is not linear: a pixel a
// quarter of which is 20 displays as white, and edges before bright light stay jagged. With these weights the mean is that of
// Reinhard's x / (1 + x), mapped back; equal samples keep their value.
//
// Uncovered samples do not count, so that color and coverage stay apart: the background joins after the tone map. Coverage and flags
// keep their plain mean (common/pixel.glsl). Numbers that are read from the picture are weighed as well. Modes that show data, means of
// many frames, thumbnails and EXR files have the plain mean.

uniform sampler2DMS samples;

layout(location = 0) out vec4 out_color;

void main() {
    vec3 light = vec3(0.0);
    float weights = 0.0;
    float alpha = 0.0;
    [[unroll]] for (int i = 0; i < int(SAMPLES); ++i) {
        vec4 x = texelFetch(samples, ivec2(gl_FragCoord.xy), i);
        float weight = 1.0 / (1.0 + clamp(frame.exposure * max_component(x.rgb), 0.0, 1e18));
        light += weight * x.rgb;
        weights += weight * coverage_of(x.a);
        alpha += x.a / float(SAMPLES);
    }
    out_color = vec4(light * (coverage_of(alpha) / max(weights, 1e-30)), alpha);
}
