//@pass ground_sky "Ground: sky" size=64x64 format=rg16f doc="Red: part of the sky's irradiance that reaches the ground, without suns; green: sin^2 of the elevation up to which the direction of the brightest sun is free"
#version 460
#include "pass.glsl"
#include "common/color.glsl"
#include "common/math.glsl"
#include "lighting/environment_map.glsl"
#include "lighting/shadows/ground.glsl"

// In each direction of the compass the model hides the sky above some elevation: that of the lowest surface over the ground, as if
// the model were solid above it. Under a uniform sky, the band from the horizon to the elevation t contributes sin^2 t of
// that azimuth's irradiance. The bands below and above t each use one blurred lookup of the environment, at the elevation
// that halves the band's irradiance. So a softbox above throws a shadow to the other side.
//
// Horizons of a height field hide the sky in the same way (Max 1988, "Horizon Mapping: Shadows for Bump-Mapped Surfaces").
//
// Limits: light that passes over an overhang of the model, or through it, is lost. The shadow of the sun is that of a larger sun.

uniform sampler2D ground_blockers;

const int DIRECTIONS = 24;
const int MOST_STEPS = 16;

// Faces of the blurred environment have this many levels below them: 4 x 4 texels, each about as wide as the parts of the sky that
// they stand for.
const int LEVELS_BELOW = 3;

// Part of the irradiance by a uniform sky that comes from this direction of the compass: sin^2 of the elevation above which the model
// hides it. More steps, up to MOST_STEPS, see the model's shape more closely. Their constant bound lets the image stay while only the camera
// moves: a pass whose loops are counted is drawn in every frame.
float open_sky(vec2 direction, int steps) {
    float open = 1.0;
    for (int step = 0; step < min(steps, MOST_STEPS); ++step) {
        // Distances grow, as near blockers hide the most: 0.4 % to 36 % of the ground.
        float far = 0.36 * pow((float(step) + 0.6) / (float(steps) - 0.4), 2.0);
        // The mean over an area as wide as the step, so that no thin wall is missed and none stands out.
        float level = log2(max(3.0 / float(steps) * far * pass.size_px.x, 1.0));
        vec2 blockers = textureLod(ground_blockers, clamp(uv + far * direction, 0.0, 1.0), level).rg;
        if (blockers.r <= 0.0) continue;
        float height = max(blockers.g / blockers.r, 0.0);
        open = min(open, 1.0 - blockers.r * (1.0 - height * height / (height * height + far * far)));
    }
    return open;
}

// Luminance of the sky in a direction of the compass, where the sky below has this part of the irradiance, sin^2 of the elevation.
float sky_luminance(vec2 direction, float irradiance_below) {
    vec3 d = vec3(0.0, sqrt(irradiance_below), 0.0);
    d.xz = sqrt(1.0 - irradiance_below) * vec2(direction.x, -direction.y);   // ground_uv: -z is up in the image
    if (!HAS_ENVIRONMENT) return 1.0;
    return luminance(environment_radiance(d, float(textureQueryLevels(environment_cube) - LEVELS_BELOW)));
}

void main() {
    float whole = 0.0;
    float left = 0.0;
    for (int i = 0; i < DIRECTIONS; ++i) {
        float angle = 2.0 * PI * (float(i) + 0.5) / float(DIRECTIONS);
        vec2 direction = vec2(cos(angle), sin(angle));
        float open = open_sky(direction, 6);
        float seen = open * sky_luminance(direction, 0.5 * open);
        whole += seen + (1.0 - open) * sky_luminance(direction, 0.5 + 0.5 * open);
        left += seen;
    }
    float sun = 1.0;
    if (SUN_COUNT != 0u) {
        vec2 towards = sun_at(0u).position_ws.xz * vec2(1.0, -1.0);
        sun = open_sky(towards / max(length(towards), 1e-3), MOST_STEPS);
    }
    // Without light there is no shadow.
    color = vec4(whole > 0.0 ? left / whole : 1.0, sun, 0.0, 1.0);
}
