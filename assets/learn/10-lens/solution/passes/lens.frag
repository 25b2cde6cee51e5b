//@pass lens "Lens" to=picture doc="Darker corners, by the cos^4 law"
#version 460
#include "pass.glsl"

uniform sampler2D picture;

// E = E0 cos^4(theta), with tan(theta) from 0 in the middle of the picture to 1 in its corners.
void main() {
    vec4 scene = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
    vec2 t = (uv - 0.5) * pass.size_px / length(0.5 * pass.size_px);
    float cos2 = 1.0 / (1.0 + dot(t, t));
    color = vec4(scene.rgb * cos2 * cos2, scene.a);
}
