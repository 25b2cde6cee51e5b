// The suns of the environment: small bright sources of the map, which irradiance and prefiltered levels leave out
// (ibl/small_lights/list.glsl). They light the surface as punctual lights do: evaluate_brdf has D, V and F for their own direction and the
// eye's, where the split sum has a lobe for v = n.
//
// Limits: a sun is a direction. Its size widens the specular lobes by its variance, and no others. Specular transmission
// (lighting/transmission.glsl) shows it as a lobe around the refracted direction.
#ifndef LIGHTING_SUN_GLSL
#define LIGHTING_SUN_GLSL

#include "interface.glsl"
#include "brdf/evaluate.glsl"
#include "brdf/surface.glsl"
#include "ibl/sampling/lobe_weight.glsl"
#include "lighting/environment.glsl"
#include "lighting/lobes.glsl"
#include "lighting/shadows/shadow.glsl"

// Parts of the environment's light that arrive, 0..1.
struct Occlusion {
    vec3 wide;                 // for lobes that gather from the whole hemisphere
    float specular;
    float clearcoat;
    float sheen;
};

// Roughness of a lobe that a sun's disk widens.
float widened_roughness(float roughness, float variance) {
    return sqrt(widened_alpha(roughness * roughness, variance));
}

// Light of sun i that the surface reflects, or transmits diffusely. The mirror level of the environment shows the suns
// themselves, so smooth lobes have less than all of them here (missing_suns).
Lobes light_of_sun(uint i, Surface s, vec3 v, Occlusion open) {
    Light sun = sun_at(i);
    vec3 l = sun.position_ws.xyz;
    float n_dot_l = dot(s.n, l);
    if (n_dot_l <= 0.0 && !LIGHT_PASSES && !coat_lies_apart()) return no_light();
    float roughness = s.roughness;
    float clearcoat_roughness = s.clearcoat_roughness;
    float variance = frame.sun_variance[i];
    s.roughness = widened_roughness(roughness, variance);
    s.clearcoat_roughness = widened_roughness(clearcoat_roughness, variance);
    Brdf brdf = evaluate_brdf(s, l, v);
    // Shadows are those of this sun. Without them, the share of the sky that is open stands for them. It is that of the side that the
    // eye sees; light from behind has not come through it.
    float open_behind = 1.0;
    if (SHADOWS != NO_SHADOWS) {
        float visible = shadow_visibility(frame.light_count + i, s.position_ws, s.ng, l);
        open = Occlusion(vec3(visible), visible, visible, visible);
        open_behind = visible;
    }
    vec3 irradiance = sun.intensity * abs(n_dot_l);
    Lobes light = no_light();
    light.diffuse = irradiance * open.wide * brdf.diffuse;
    light.multiple = irradiance * open.wide * brdf.multiple;
    light.specular = irradiance * (open.specular * missing_suns(roughness)) * brdf.specular;
    light.clearcoat = irradiance * (open.clearcoat * missing_suns(clearcoat_roughness)) * brdf.clearcoat;
    light.sheen = irradiance * open.sheen * brdf.sheen;
    light.transmitted = irradiance * open_behind * brdf.diffuse_transmitted;
    return light;
}

// Adds the light of all suns. The sum of the lobes (Lobes::all) stays.
void add_suns(inout Lobes to, Surface s, vec3 v, Occlusion open) {
    [[unroll]] for (uint i = 0u; i < SUN_COUNT; ++i) add(to, light_of_sun(i, s, v, open), vec3(1.0));
}

#endif
