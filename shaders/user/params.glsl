// Parameters of the hooks, in user.glsl and beside this file, and of passes.
//
// A member of Params with an @ui comment gets a slider or a color picker in the window, and `--set NAME=VALUE` on the
// command line; changing its value compiles nothing. All shaders that include this file read the same values.
#ifndef USER_PARAMS_GLSL
#define USER_PARAMS_GLSL

#include "interface.glsl"

layout(set = SET_FRAME, binding = BINDING_PARAMS, scalar) uniform Params {
    float roughness_scale;     //@ui "Roughness scale" 0..2 group="Material" doc="Roughness of all materials, times this" = 1.0
    float rim_strength;        //@ui "Rim" 0..1 group="Material" doc="A glow along silhouettes. Not physical: no light source causes it" = 0.0
    float rim_power;           //@ui "Rim power" 1..8 group="Material" doc="How narrow the rim is" = 3.0
    vec3 rim_color;            //@ui "Rim color" color group="Material" = 1 0.8 0.6
    float bloom_strength;      //@ui "Bloom strength" 0..1 when=BLOOM = 0.12
    int bloom_levels;          //@ui "Bloom width" 2..8 when=BLOOM doc="Mip levels that are blurred: each doubles the reach" = 5
    float shadow_softness;     //@ui "Shadow softness" 0..0.5 when=SHADOWS = 0.1
};

#endif
