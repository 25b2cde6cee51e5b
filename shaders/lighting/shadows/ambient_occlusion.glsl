// Ambient occlusion of the model by itself. passes/occlusion/occlusion.frag draws it at half the picture's size.
#ifndef LIGHTING_AMBIENT_OCCLUSION_GLSL
#define LIGHTING_AMBIENT_OCCLUSION_GLSL

#include "interface.glsl"
#include "common/math.glsl"
#include "common/picture_px.glsl"
#include "lighting/shadows/occlusion_texel.glsl"

//@ui "Ambient occlusion" doc="Corners and gaps get less light from the environment (GTAO, Jimenez et al. 2016)"
layout(constant_id = USER_CONSTANTS + 11) const bool AMBIENT_OCCLUSION = false;

// pack_occlusion() of the hidden part, 0 open .. 1 hidden. 0 where there is nothing or the pass is off.
uniform sampler2D occlusion;

// Open part of the hemisphere over the pixel's surface, 0..1: of the four nearest texels, those at about its distance count.
// `distance_m`: along the camera's axis. The image holds no blended surface (passes/occlusion/geometry.frag). What lies behind one
// does not hide the sky from it, so a blended surface is open as far as no texel fits.
float screen_visibility(float distance_m) {
    if (!AMBIENT_OCCLUSION) return 1.0;
    vec2 size = ceil(0.5 * frame.viewport_px);
    vec2 texel = picture_px() / frame.viewport_px * size - 0.5;
    vec2 part = fract(texel);
    vec4 texels = textureGather(occlusion, (floor(texel) + 1.0) / size);
    vec4 error = abs(unpack_radii(texels) * (frame.scene_radius / distance_m) - 1.0);
    // A gather holds (0, 1), (1, 1), (1, 0), (0, 0). 1e-4: if no texel is of this opaque surface, which is thinner than one, all count.
    vec4 weight = vec4((1.0 - part.x) * part.y, part.x * part.y, part.x * (1.0 - part.y), (1.0 - part.x) * (1.0 - part.y));
    if (ALPHA_MODE == ALPHA_BLEND) {
        weight *= max(1.0 - 50.0 * error, 0.0);
        return saturate(1.0 - dot(texels, weight));
    }
    weight *= max(1.0 - 50.0 * error, 1e-4);
    return saturate(1.0 - dot(texels, weight) / dot(weight, vec4(1.0)));
}

// Visibility for light that is reflected between the surfaces too, for albedo `a` (Jimenez et al. 2016, eq. 10, a fit).
// Open: 1. Bright surfaces are hidden less.
vec3 with_bounces(float visibility, vec3 a) {
    vec3 x = 2.0404 * a - 0.3324;
    vec3 y = -4.7951 * a + 0.6417;
    vec3 z = 2.7552 * a + 0.6903;
    return max(vec3(visibility), ((visibility * x + y) * visibility + z) * visibility);
}

#endif
