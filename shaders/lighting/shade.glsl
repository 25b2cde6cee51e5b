// Lights a surface: the rendering equation (Kajiya 1986) with a sum over the lights, and the split sum for light from
// all directions.
#ifndef LIGHTING_SHADE_GLSL
#define LIGHTING_SHADE_GLSL

#include "interface.glsl"
#include "brdf/evaluate.glsl"
#include "lighting/albedo.glsl"
#include "lighting/image_based.glsl"
#include "lighting/light_grid.glsl"
#include "lighting/lobes.glsl"
#include "lighting/punctual.glsl"
#include "lighting/rectangle.glsl"
#include "lighting/shadows/ambient_occlusion.glsl"
#include "lighting/shadows/shadow.glsl"
#include "lighting/transmission.glsl"

// Radiance towards the eye, by source.
struct Lit {
    Lobes punctual;            // punctual lights
    Lobes area;                // rectangular lights
    Lobes ambient;             // the environment, or uniform ambient light
    vec3 behind;               // what is seen through the surface
    vec3 emitted;              // emission, attenuated by the coat (KHR_materials_clearcoat)
    Lobes lobes;               // of the BRDF, 1/sr, summed over the lights regardless of their intensity
    Brdf last;                 // of the last light evaluated
};

// Lights first .. end - 1.
struct LightRange {
    uint first;
    uint end;
    bool for_terms;            // fill in Lit's `lobes` and `last`, even for lights that do not reach the surface
};

// The loop over a constant LIGHT_COUNT is unrolled. A software device then reads a light once for a group of pixels instead of for
// each.
LightRange all_lights() { return LightRange(0u, LIGHT_COUNT != 0u ? LIGHT_COUNT : frame.light_count, false); }

// The lights that most debug modes of direct light show: the selected light, or all. Empty if there is none or the
// material is unlit.
LightRange chosen_lights() {
    uint end = (FEATURES & FEATURE_UNLIT) != 0u ? 0u : frame.light_count;
    if (frame.chosen_light == 0u) return LightRange(0u, end, false);
    return LightRange(frame.chosen_light - 1u, min(frame.chosen_light, end), false);
}

bool is_empty(LightRange range) { return range.first >= range.end; }

bool is_in(LightRange range, uint i) { return i >= range.first && i < range.end; }

// Attenuates transmitted light by the volume's thickness, wherever the light comes from.
void cross_volume(Surface s, inout Lobes light) {
    light.all -= light.transmitted;
    light.transmitted *= attenuation(s, s.thickness);
    light.all += light.transmitted;
}

// True if light from l can be skipped: it is behind the mesh, or below the horizon of the shading normal and there is no coat with a
// normal of its own. A surface that transmits light skips none, and neither does a debug mode that wants the terms.
bool is_below_horizon(Surface s, vec3 l, bool for_terms) {
    if (LIGHT_PASSES || for_terms) return false;
    return dot(s.ng, l) <= 0.0 || (dot(s.n, l) <= 0.0 && !coat_lies_apart());
}

// Part of light `i` that other surfaces let through, 0..1.
float light_visibility(uint i, Surface s, bool for_terms) {
    Light light = light_at(i, s.position_ws);
    vec3 l = illuminate(light, s.position_ws).l;
    bool has_size = (FEATURES & FEATURE_RECT_LIGHTS) != 0u && light.kind == LIGHT_RECT;
    if (!has_size && is_below_horizon(s, l, for_terms)) return 1.0;
    return shadow_visibility(i, s.position_ws, s.ng, l);
}

// Adds what the surface reflects of light `i`, of which the part `visibility` arrives. `for_terms`: see LightRange.
void add_light(inout Lit lit, Surface s, vec3 v, Albedo albedo, uint i, float visibility, bool for_terms) {
    Light light = light_at(i, s.position_ws);
    // For BRDF terms a rectangle counts as a point light at its center.
    bool has_size = (FEATURES & FEATURE_RECT_LIGHTS) != 0u && !for_terms && light.kind == LIGHT_RECT;
    if (has_size) {
        add(lit.area, rectangle_light(s, v, albedo, light), vec3(visibility));
        return;
    }
    // L = f E |NoL|, with E the irradiance on a plane perpendicular to l.
    Illumination illumination = illuminate(light, s.position_ws);
    if (is_below_horizon(s, illumination.l, for_terms)) return;
    if (MANY_LIGHTS != 0u && !for_terms && illumination.irradiance == vec3(0.0)) return;
    lit.last = evaluate_brdf(s, illumination.l, v);
    Lobes lobes = lobes_of(lit.last);
    add(lit.lobes, lobes, vec3(1.0));
    vec3 irradiance = illumination.irradiance * (abs(dot(s.n, illumination.l)) * visibility);
    add(lit.punctual, lobes, irradiance);
}

// Adds what the surface reflects of many lights.
void add_many(inout Lit lit, Surface s, vec3 v, Albedo albedo, LightRange range) {
    // Terms count even of lights that do not reach the surface.
    if (range.for_terms) {
        for (uint i = range.first; i < min(range.end, uint(MAX_LIGHTS)); ++i) add_light(lit, s, v, albedo, i, 1.0, true);
        return;
    }
    // Shadows first, since the loops in them would count for each of the many lights (src/shader/spirv/loops/mod.rs).
    float visibility[MAX_LIGHT_VIEWS];
    if (SHADOWS != NO_SHADOWS) {
        for (uint i = 0u; i < MAX_LIGHT_VIEWS; ++i) visibility[i] = is_in(range, i) ? light_visibility(i, s, false) : 1.0;
    }
    LightWalk walk = lights_near(s.position_ws);
    for (uint n = 0u; n < uint(MAX_LIGHTS); ++n) {
        uint i = next_light(walk);
        if (i == NO_LIGHT) break;
        if (!is_in(range, i)) continue;
        bool has_shadow = SHADOWS != NO_SHADOWS && i < MAX_LIGHT_VIEWS;
        add_light(lit, s, v, albedo, i, has_shadow ? visibility[min(i, uint(MAX_LIGHT_VIEWS) - 1u)] : 1.0, false);
    }
}

Lit shade(Surface s, vec3 v, LightRange range) {
    // Visibility first, while few values are live: a software device has few registers.
    s.occlusion *= screen_visibility(1.0 / gl_FragCoord.w);
    float visibility[MAX_LIGHT_VIEWS];
    if (LIGHT_COUNT != 0u) {
        [[unroll]] for (uint i = 0u; i < LIGHT_COUNT; ++i) {
            if (is_in(range, i)) visibility[i] = light_visibility(i, s, range.for_terms);
        }
    }
    Albedo albedo = directional_albedo(s, v);
    Lit lit;
    lit.punctual = lit.area = lit.lobes = no_light();
    lit.ambient = with_sum(environment_light(s, v, albedo));
    lit.behind = vec3(0.0);
    lit.emitted = s.emissive * albedo.under_coat;
    if ((FEATURES & FEATURE_TRANSMISSION) != 0u) lit.behind = albedo.transmitted * transmitted_radiance(s, v);
    if (LIGHT_COUNT != 0u) {
        [[unroll]] for (uint i = 0u; i < LIGHT_COUNT; ++i) {
            if (is_in(range, i)) add_light(lit, s, v, albedo, i, visibility[i], range.for_terms);
        }
    } else if (MANY_LIGHTS == 0u) {
        // With a limit that the compiler can see, the loop needs no budget of rounds.
        for (uint i = range.first; i < min(range.end, uint(FEW_LIGHTS)); ++i) {
            add_light(lit, s, v, albedo, i, light_visibility(i, s, range.for_terms), range.for_terms);
        }
    } else {
        add_many(lit, s, v, albedo, range);
    }
    if (LIGHT_PASSES && (FEATURES & FEATURE_VOLUME) != 0u) {
        cross_volume(s, lit.punctual);
        cross_volume(s, lit.area);
        cross_volume(s, lit.ambient);
    }
    return lit;
}

#endif
