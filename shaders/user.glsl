// Start here. This file is yours: it has hooks into the shading of the model. With the default values they change nothing.
//
//   user.glsl              user_surface, user_light and user_radiance
//   user/params.glsl       sliders and colors, for all hooks
//   user/vertex.glsl       user_vertex: moves vertices
//   user/background.glsl   user_background: changes the environment behind the model
//   user/display.glsl      user_display: changes exposed light before the tone map
//
// A constant_id with a `choice` gets a list in the window; each choice is a pipeline of its own, without the code of the
// other choices.
#ifndef USER_GLSL
#define USER_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "common/color.glsl"
#include "common/fragment.glsl"
#include "user/params.glsl"

// Give your own constants the ids USER_CONSTANTS + 16 and up. The ids below belong to the files that come with Specula.
layout(constant_id = USER_CONSTANTS + 1) const uint TOON_BANDS = 0u;   //@ui "Toon" choice Off=0 Two=2 Three=3 Four=4 group="Material" doc="Steps of brightness in place of a gradient"

// The surface before it is lit: change the material here. `f`: what the vertices give, such as texture coordinates (f.uv0, f.uv1)
// and COLOR_0 (f.color). `v`: towards the viewer, unit. brdf/surface.glsl lists the members of Surface.
//
//     s.base_color = mix(s.base_color, vec3(0.02), step(0.5, fract(8.0 * f.uv0.x)));
//     s.clearcoat = 1.0;                   an extension that the material lacks is switched on by a line that sets it
//     s.coverage *= step(0.3, f.uv0.y);    cuts a masked material, and its shadow
//
// s.f0 follows s.ior unless you set it; the frame s.t, s.b follows s.n. The debug modes show the surface as you leave it, and
// shadow maps, ambient occlusion, the ground and path tracing see it too. A hit of path tracing has no neighboring pixels:
// texture() reads level 0 there, dFdx, dFdy and fwidth are 0. They know one set of texture coordinates, that of the material's
// textures, as f.uv0 and as f.uv1.
void user_surface(inout Surface s, Fragment f, vec3 v) {
    s.roughness = saturate(s.roughness * roughness_scale);
}

// A light before it shines on a point: change its color, place or reach here. `index`: its number, from 0. Intensities are
// in candela (point, spot), lux (directional) or cd/m^2 (rectangle). The environment is no light of this kind. A light has one
// shadow map, so its shadow is that of the light which shines on the center of the model.
void user_light(inout Light light, uint index, vec3 position_ws) {
}

// The radiance that reaches the eye, cd/m^2: change the result of lighting here.
vec3 user_radiance(Surface s, vec3 v, vec3 radiance) {
    // Rim light: grows where the surface turns away from the eye. It has no light source.
    radiance += rim_color * rim_strength * pow(1.0 - saturate(dot(s.n, v)), rim_power);

    // Toon: quantizes L / (1 + L), so that dark and bright luminances get equally many bands.
    if (TOON_BANDS > 0u) {
        float seen = max(luminance(radiance) * frame.exposure, 1e-6);   // 1e-6: a division by it follows
        // min: above 1.7e7, L / (1 + L) rounds to 1, which would be one band too many.
        float step = min(floor(seen / (1.0 + seen) * float(TOON_BANDS)), float(TOON_BANDS) - 1.0);
        float band = (step + 0.5) / float(TOON_BANDS);
        radiance *= band / (1.0 - band) / seen;
    }
    return radiance;
}

#endif
