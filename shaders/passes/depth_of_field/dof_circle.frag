//@pass dof_circle "Depth of field: circles" format=r32f doc="Radius of the circle of confusion, pixels: below 0 in front of the focus, above 0 behind it"
#version 460
#include "pass.glsl"
#include "lens.glsl"

// A thin lens of diameter A that focuses on the distance s spreads a point at the distance d over a circle of the focused plane, of
// the diameter A |d - s| / d (Potmesil & Chakravarty 1981, "A Lens and Aperture Camera Model for Synthetic Image Generation",
// divided by the magnification). In f-numbers, A is the focal length / N.

uniform sampler2D depth;

uniform DofCircle {
    float dof_aperture;        //@ui "Aperture, of the model's radius" 0..0.5 = 0.12
    float dof_focus;           //@ui "Focus behind the model's center, of its radius" -2..2 = 0
};

// Depth of the nearest surface that touches the pixel or one of its neighbors. A pixel on the model's edge mixes samples of the model
// with those of the background: it is as sharp as the model.
float nearest_depth() {
    vec2 half_pixel = 0.5 / pass.size_px;
    vec4 depths = max(textureGather(depth, uv - half_pixel), textureGather(depth, uv + half_pixel));
    return max(max(depths.x, depths.y), max(depths.z, depths.w));
}

void main() {
    float center_m = -(frame.view_from_world * vec4(frame.scene_center_ws, 1.0)).z;
    float focus_m = max(center_m + dof_focus * frame.scene_radius, 0.01 * frame.scene_radius);
    // The second row of the projection is the vertical axis, divided by half the picture's height at 1 m.
    mat4 m = frame.clip_from_world;
    float half_height_at_1m = inversesqrt(dot(vec3(m[0].y, m[1].y, m[2].y), vec3(m[0].y, m[1].y, m[2].y)));
    // Depth is near / distance. So (d - s) / d is linear in it, and 1 where nothing is.
    float behind = 1.0 - nearest_depth() * focus_m / frame.near;
    float pixels_per_meter = 0.5 * pass.size_px.y / (half_height_at_1m * focus_m);
    float radius = 0.5 * dof_aperture * frame.scene_radius * behind * pixels_per_meter;
    float largest = LARGEST_BLUR * pass.size_px.y;
    color = vec4(clamp(radius, -largest, largest), 0.0, 0.0, 1.0);
}
