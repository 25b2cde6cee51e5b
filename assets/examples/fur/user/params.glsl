// Parameters of the hooks and of the fur.
#ifndef USER_PARAMS_GLSL
#define USER_PARAMS_GLSL

#include "interface.glsl"

layout(set = SET_FRAME, binding = BINDING_PARAMS, scalar) uniform Params {
    float roughness_scale;     //@ui "Roughness scale" 0..2 = 1.0
    float rim_strength;        //@ui "Rim" 0..1 = 0.0
    float rim_power;           //@ui "Rim power" 1..8 = 3.0
    vec3 rim_color;            //@ui "Rim color" color = 1 0.8 0.6
    float shadow_softness;     //@ui "Shadow softness" 0..0.5 when=SHADOWS = 0.1
    float fur_length;          //@ui "Fur length, of the model's radius" 0..0.3 = 0.1
    float fur_density;         //@ui "Hairs across the model's radius" 10..200 = 60
    vec3 fur_color;            //@ui "Fur color" color = 0.6 0.35 0.15
};

#endif
