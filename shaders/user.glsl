// Start here. This file is yours: it has two hooks into the picture and parameters for them. With the default values
// they change nothing.
//
// A member of Params with an @ui comment gets a slider or a color picker in the window, and `--set shader.NAME=VALUE`
// on the command line; changing its value compiles nothing. A constant_id with a `choice` gets a list; each choice is a
// pipeline of its own, without the code of the other choices.
#ifndef USER_GLSL
#define USER_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "common/color.glsl"

// Give your own constants the ids USER_CONSTANTS + 16 and up. The ids below belong to brdf/models.glsl and this file.
layout(constant_id = USER_CONSTANTS + 1) const uint TOON_BANDS = 0u;   //@ui "Toon" choice Off=0 Two=2 Three=3 Four=4

layout(set = SET_FRAME, binding = BINDING_PARAMS, scalar) uniform Params {
    float roughness_scale;     //@ui "Roughness scale" 0..2 = 1.0
    float rim_strength;        //@ui "Rim" 0..1 = 0.0
    float rim_power;           //@ui "Rim power" 1..8 = 3.0
    vec3 rim_color;            //@ui "Rim color" color = 1 0.8 0.6
};

// The surface before it is lit: change the material here. The debug modes show the surface as you leave it.
void user_surface(inout Surface s) {
    s.roughness = saturate(s.roughness * roughness_scale);
}

// The radiance that reaches the eye: change the result of lighting here.
vec3 user_radiance(Surface s, vec3 v, vec3 radiance) {
    // Rim light: grows where the surface turns away from the eye. It has no light source.
    radiance += rim_color * rim_strength * pow(1.0 - saturate(dot(s.n, v)), rim_power);

    // Toon: quantizes L / (1 + L), so that dark and bright luminances get equally many bands.
    if (TOON_BANDS > 0u) {
        float seen = max(luminance(radiance) * frame.exposure, 1e-6);   // 1e-6: a division by it follows
        float band = (floor(seen / (1.0 + seen) * float(TOON_BANDS)) + 0.5) / float(TOON_BANDS);
        radiance *= band / (1.0 - band) / seen;
    }
    return radiance;
}

#endif
