//@pass image "Image" to=picture after=tonemap doc="A shader as Shadertoy has them"
#version 460
#include "toy.glsl"

// Paste the text of an image shader here: toy.glsl declares iResolution, iTime, iTimeDelta, iFrame and iMouse, and calls
// mainImage. For iChannel0 write `uniform sampler2D NAME;` and `#define iChannel0 NAME`, where NAME is a //@texture or a pass.

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 p = (2.0 * fragCoord - iResolution.xy) / iResolution.y;
    vec3 sum = vec3(0.0);
    for (int i = 1; i <= 4; ++i) {
        float wave = sin(float(i) * 2.0 * length(p) - 1.5 * iTime + float(i));
        sum += (0.5 + 0.5 * cos(6.2831853 * (0.2 * float(i) + vec3(0.0, 0.33, 0.67)))) * 0.02 / abs(wave + 0.6 * p.y);
    }
    fragColor = vec4(1.0 - exp(-sum), 1.0);
}
