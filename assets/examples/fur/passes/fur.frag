//@pass fur "Fur" draw=model to=picture instances=24 doc="Shells around the model, of which a fragment is left where a hair is"
#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "lighting/environment.glsl"
#include "lighting/light_grid.glsl"
#include "lighting/punctual.glsl"
#include "material/opaque.glsl"

// Fur by shells (Lengyel, Praun, Finkelstein & Hoppe 2001, "Real-Time Fur over Arbitrary Surfaces"), lit as hairs (Kajiya & Kay
// 1989, "Rendering Fur with Three Dimensional Textures", diffuse term: the sine between hair and light).

uniform Fur {
    float fur_density;         //@ui "Hairs across the model's radius" 10..200 = 60
    vec3 fur_color;            //@ui "Fur color" color = 0.6 0.35 0.15
};

layout(location = 0) in Fragment fragment;
layout(location = 12) in float height;
layout(location = 0) out vec4 color;

void main() {
    // Hair grows where the skin has no hole.
    Fragment skin = fragment;
    skin.position_ws = fragment.color.xyz;
    skin.color = vec4(1.0);
    discard_holes(skin);
    // A hair in each cell of a lattice on the skin: a cone of random length.
    vec3 cell = fragment.color.xyz / frame.scene_radius * fur_density;
    vec3 random = random_numbers(uvec3(ivec3(floor(cell)) + 4096));
    float from_center = length(fract(cell) - 0.5);
    float tip = mix(0.4, 1.0, random.x);
    if (height > tip || from_center > 0.75 * (1.0 - height / tip)) discard;

    vec3 hair = normalize(fragment.normal_ws + vec3(0.0, -0.4, 0.0) * height);
    vec3 light = irradiance_over_pi(fragment.normal_ws);
    LightWalk walk = lights_near(fragment.position_ws);
    for (uint n = 0u; n < uint(MAX_LIGHTS); ++n) {
        uint i = next_light(walk);
        if (i == NO_LIGHT) break;
        Illumination from = illuminate(light_at(i, fragment.position_ws), fragment.position_ws);
        float along = dot(hair, from.l);
        float faces = saturate(dot(fragment.normal_ws, from.l) + 0.3);
        light += from.irradiance / PI * sqrt(saturate(1.0 - along * along)) * faces;
    }
    // Deep in the fur it is dark.
    vec3 albedo = fur_color * mix(0.7, 1.3, random.y);
    color = vec4(albedo * light * mix(0.25, 1.0, height), 1.0);
}
