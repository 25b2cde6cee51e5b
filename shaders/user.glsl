// Yours: start here. Two hooks into the picture, and sliders for them. At the default values they change nothing.
//
// A member of Params whose line ends in an @ui comment is a slider or a color in the window and `shader.NAME=VALUE` for
// `--set` on the command line; moving it compiles nothing. A constant_id with a `choice` is a list; choosing builds
// another pipeline, in which the paths not taken cost nothing.
#ifndef USER_GLSL
#define USER_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "common/color.glsl"

// Constants of your own take USER_CONSTANTS + 16 and up; those below belong to brdf/models.glsl and to this file.
layout(constant_id = USER_CONSTANTS + 1) const uint TOON_BANDS = 0u;   //@ui "Toon" choice Off=0 Two=2 Three=3 Four=4

layout(set = SET_FRAME, binding = BINDING_PARAMS, scalar) uniform Params {
    float roughness_scale;     //@ui "Roughness scale" 0..2 = 1.0
    float rim_strength;        //@ui "Rim" 0..1 = 0.0
    float rim_power;           //@ui "Rim power" 1..8 = 3.0
    vec3 rim_color;            //@ui "Rim color" color = 1 0.8 0.6
};

// The surface before it is lit: change what it is made of. The debug modes show it as you leave it.
void user_surface(inout Surface s) {
    s.roughness = saturate(s.roughness * roughness_scale);
}

// The light that leaves the surface: change what the eye gets.
vec3 user_radiance(Surface s, vec3 v, vec3 radiance) {
    // A rim: light where the surface turns away from the eye, from nowhere in particular.
    radiance += rim_color * rim_strength * pow(1.0 - saturate(dot(s.n, v)), rim_power);

    // Toon: luminance in steps, equal ones on the scale of L / (1 + L), so that dark and bright get as many.
    if (TOON_BANDS > 0u) {
        float seen = max(luminance(radiance) * frame.exposure, 1e-6);   // 1e-6: black has no luminance to divide by
        float band = (floor(seen / (1.0 + seen) * float(TOON_BANDS)) + 0.5) / float(TOON_BANDS);
        radiance *= band / (1.0 - band) / seen;
    }
    return radiance;
}

#endif
