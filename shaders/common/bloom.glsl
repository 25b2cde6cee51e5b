// Bloom: light that a lens scatters around what is bright. passes/bloom/bloom.frag draws it.
#ifndef COMMON_BLOOM_GLSL
#define COMMON_BLOOM_GLSL

#include "interface.glsl"
#include "common/math.glsl"
#include "user/params.glsl"

layout(constant_id = USER_CONSTANTS + 12) const bool BLOOM = false;  //@ui "Bloom" doc="Light that a lens scatters around what is bright (Jimenez 2014)"

// Mean of ever wider blurs of the exposed light.
uniform sampler2D bloom;

// A lens scatters a part of all light, so no threshold is needed: the picture is mixed with blurs of itself (Jimenez 2014,
// "Next Generation Post Processing in Call of Duty: Advanced Warfare"). Flat areas keep their light. A single very bright
// pixel loses most of what it should scatter, since bloom_light.frag limits its weight so that it does not flicker. `light`:
// exposed, times coverage. `uv`: 0..1 in the picture.
//
// Outside the model, bloom adds coverage in proportion to its brightness, so that the glow survives a transparent background.
//
// Limits: the blurs are round, without the streaks of an iris, and lack light from beyond the picture's border.
void add_bloom(inout vec3 light, inout float coverage, vec2 uv) {
    vec3 blur = bloom_strength * texture(bloom, uv).rgb;
    light = light * (1.0 - bloom_strength) + blur;
    coverage = max(coverage, saturate(max(blur.r, max(blur.g, blur.b))));
}

#endif
