// The sun of a built-in sky, which the prefiltered levels do not have from level 1 on (ibl/small_lights/list.glsl). It is lit as
// a lamp is: by evaluate_brdf, with D, V and F for its own direction and the eye's. In the split sum it would be a lobe for v = n.
#ifndef LIGHTING_SUN_GLSL
#define LIGHTING_SUN_GLSL

#include "interface.glsl"
#include "brdf/evaluate.glsl"
#include "brdf/surface.glsl"
#include "lighting/environment.glsl"

// f |NoL| of the coat or of the base's specular lobe.
vec3 weight_of(Surface s, vec3 v, vec3 l, bool is_coat) {
    Brdf brdf = evaluate_brdf(s, l, v);
    return (is_coat ? brdf.clearcoat : brdf.specular) * abs(dot(s.n, l));
}

// Sunlight that the base's specular lobe or the coat reflects, without the environment's intensity. The variance of the disk
// widens the lobe, as in lobe_weight_of_light.
vec3 reflected_sun(Surface s, vec3 v, bool is_coat) {
    vec2 roughness = vec2(s.roughness, s.clearcoat_roughness);
    vec2 widened = sqrt(sqrt(roughness * roughness * roughness * roughness + frame.sun_variance));
    s.roughness = widened.x;
    s.clearcoat_roughness = widened.y;
    return frame.sun_intensity * weight_of(s, v, world_from_map(frame.sun_direction), is_coat);
}

// The same for sheen, which is wider than the disk.
vec3 sun_from_sheen(Surface s, vec3 v) {
    vec3 l = world_from_map(frame.sun_direction);
    return frame.sun_intensity * evaluate_brdf(s, l, v).sheen * max(dot(s.n, l), 0.0);
}

#endif
