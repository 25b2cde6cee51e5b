//@pass shadow_map "Shadow map" draw=model instances=lights cull=none size=2048x2048 format=r16f when=SHADOWS doc="Depth of what is nearest to each light; a tile for each"
#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "material/opaque.glsl"

// The surface that is nearest to each light (Williams 1978, "Casting Curved Shadows on Curved Surfaces").
//
// Limits: 2048 pixels are shared by all lights, so edges become blocky with many of them. A surface blocks all light or none
// (material/opaque.glsl).

layout(location = 0) in Fragment fragment;
layout(location = 12) in vec2 in_tile;
layout(location = 0) out vec4 color;

void main() {
    discard_see_through(fragment);
    // A light inside the model sees parts of it beyond its tile. gl_FragCoord.w is 1 / w.
    if (any(greaterThan(abs(in_tile) * gl_FragCoord.w, vec2(1.0)))) discard;
    // A half float is off by up to 1 part in 2048. It must not be nearer to the light than the surface, which would hide itself.
    color = vec4(gl_FragCoord.z * (1.0 - 1.0 / 2048.0), 0.0, 0.0, 1.0);
}
