//@pass deferred "Deferred: picture" to=picture doc="The deferred light in place of the model's own"
#version 460
#include "pass.glsl"
#include "common/pixel.glsl"

// Puts the light of the lighting pass into the picture. Coverage and flags are those of the model's own pass, so that edges stay
// antialiased and exports keep their alpha. Materials that the G-buffer cannot hold (blended, transmissive, layered) stay as the
// model's own pass draws them: the forward pass of a deferred renderer.
//
// Limits: the G-buffer has one sample for each pixel, so edges inside the model are aliased. So are outlines before an environment,
// where coverage is 1 everywhere. Where a blended surface covers a deferred one, the pixel stays as the forward pass draws it.

uniform sampler2D picture;
uniform sampler2D deferred_light;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 scene = texelFetch(picture, pixel, 0);
    vec4 light = texelFetch(deferred_light, pixel, 0);
    color = scene;
    if (light.a > 0.0) {
        vec4 lit = hdr_pixel(light.rgb, coverage_of(scene.a), false);
        color = vec4(lit.rgb, max(scene.a, lit.a));
    }
}
