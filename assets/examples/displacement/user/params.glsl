// Parameters of the hooks, and those of the displacement.
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
    float rock_height;         //@ui "Height of the rock" 0..0.2 = 0.04
    float rock_scale;          //@ui "Bumps across the model's radius" 1..20 = 4.0
    float part_px;             //@ui "Edges of triangles, pixels" 2..64 = 6.0
};

#endif
