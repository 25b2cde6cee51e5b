//@pass peel "Peel" to=peel doc="The depth of the next layer of blended surfaces, in each sample, where view.blend_layers sorts them in each pixel"
#version 460
#include "interface.glsl"

// Depth peeling (Everitt 2001, "Interactive Order-Independent Transparency"), from back to front. The depth test keeps the farthest of
// the fragments that pass here: those in front of the last layer. So it finds the next layer, which is then drawn where the depth of its
// surfaces is equal. Layer 0 is the opaque scene. Depth is reversed: greater is nearer.

uniform sampler2D peeled;           // Depth of the last layer, with one sample per pixel,
uniform sampler2DMS peeled_samples; // or with several.

layout(location = 0) out vec4 out_color;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float last;
    if (SAMPLES > 1u) {
        last = texelFetch(peeled_samples, pixel, gl_SampleID).r;
    } else {
        last = texelFetch(peeled, pixel, 0).r;
    }
    if (gl_FragCoord.z <= last) discard;
    out_color = vec4(0.0); // Only depth is kept.
}
