//@pass life_shown "Life: cells" to=picture after=tonemap doc="The cells over the picture"
#version 460
#include "pass.glsl"

uniform sampler2D picture;
uniform sampler2D life;

uniform LifeShown {
    vec3 life_color;           //@ui "Cells" color = 0.2 0.9 0.4
    float life_strength;       //@ui "Cells over the picture" 0..1 = 0.9
};

void main() {
    // The nearest cell, so that cells are squares.
    float lives = texelFetch(life, ivec2(uv * vec2(textureSize(life, 0))), 0).r;
    vec4 scene = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
    color = vec4(mix(scene.rgb, life_color, lives * life_strength), max(scene.a, lives * life_strength));
}
