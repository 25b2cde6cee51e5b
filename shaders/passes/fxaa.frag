//@pass fxaa "FXAA" to=picture after=lut off doc="Smooths jagged edges of the displayed picture"
#version 460
#include "pass.glsl"
#include "common/color.glsl"

// Fast approximate antialiasing (Lottes 2009, "FXAA"; Jimenez et al. 2011, "Filtering Approaches for Real-Time Anti-Aliasing"). An
// edge that is almost horizontal or vertical is a staircase. The pass finds both ends of a pixel's step and blends the pixel with
// its neighbor across the edge, by the area that a straight line between the middles of the step's ends would cut off.
//
// Limits: it sees a single sample for each pixel, so details narrower than a pixel still flicker, and fine text gets softer. Long
// steps count up to 28 pixels on each side.

uniform sampler2D picture;

uniform Fxaa {
    float fxaa_subpixel;       //@ui "FXAA: single pixels" 0..1 = 0.25
    float fxaa_threshold;      //@ui "FXAA: edge threshold" 0.03..0.35 = 0.15
};

// Differences below this are invisible in dark parts.
const float DARK_THRESHOLD = 0.04;

// Color times alpha, so that the color of a transparent pixel does not count.
vec4 pixel_at(ivec2 pixel) {
    vec4 value = texelFetch(picture, clamp(pixel, ivec2(0), ivec2(pass.size_px) - 1), 0);
    return vec4(value.rgb * value.a, value.a);
}

// Brightness as the display shows it, 0..1, plus alpha: the edge of an opaque pixel beside a transparent one is at least 1.
float brightness(vec4 value) { return luma(value.rgb) + value.a; }

float brightness_at(ivec2 pixel) { return brightness(pixel_at(pixel)); }

// Length of step `i` of the search, pixels. In all 28.
int stride(int i) { return i < 4 ? 1 : i < 8 ? 2 : 4; }
const int STEPS = 12;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 here = pixel_at(pixel);
    float middle = brightness(here);
    float up = brightness_at(pixel + ivec2(0, -1));
    float down = brightness_at(pixel + ivec2(0, 1));
    float left = brightness_at(pixel + ivec2(-1, 0));
    float right = brightness_at(pixel + ivec2(1, 0));
    float up_left = brightness_at(pixel + ivec2(-1, -1));
    float up_right = brightness_at(pixel + ivec2(1, -1));
    float down_left = brightness_at(pixel + ivec2(-1, 1));
    float down_right = brightness_at(pixel + ivec2(1, 1));

    float darkest = min(middle, min(min(up, down), min(left, right)));
    float brightest = max(middle, max(max(up, down), max(left, right)));
    float contrast = brightest - darkest;
    bool is_edge = contrast > max(DARK_THRESHOLD, fxaa_threshold * (brightest - here.a));

    // Second differences across a horizontal and across a vertical edge; the middle row and column count twice.
    float across_y = 2.0 * abs(up + down - 2.0 * middle) + abs(up_left + down_left - 2.0 * left)
        + abs(up_right + down_right - 2.0 * right);
    float across_x = 2.0 * abs(left + right - 2.0 * middle) + abs(up_left + up_right - 2.0 * up)
        + abs(down_left + down_right - 2.0 * down);
    bool is_horizontal = across_y >= across_x;
    ivec2 along = is_horizontal ? ivec2(1, 0) : ivec2(0, 1);

    // The edge runs between this pixel and the neighbor that differs the most.
    float before = is_horizontal ? up : left;
    float after = is_horizontal ? down : right;
    bool is_before = abs(before - middle) >= abs(after - middle);
    ivec2 across = is_before ? -along.yx : along.yx;
    float other = is_before ? before : after;
    float edge = 0.5 * (middle + other);
    float step_ends = 0.25 * abs(other - middle);

    // The step ends where the mean of both rows is no longer that of the edge. Without an edge, the loop takes no turn.
    ivec2 low = pixel;
    ivec2 high = pixel;
    float low_change = 0.0;
    float high_change = 0.0;
    for (int i = 0; i < STEPS && is_edge; ++i) {
        bool low_open = abs(low_change) < step_ends;
        bool high_open = abs(high_change) < step_ends;
        if (!low_open && !high_open) break;
        if (low_open) {
            low -= stride(i) * along;
            low_change = 0.5 * (brightness_at(low) + brightness_at(low + across)) - edge;
        }
        if (high_open) {
            high += stride(i) * along;
            high_change = 0.5 * (brightness_at(high) + brightness_at(high + across)) - edge;
        }
    }
    ivec2 lengths = ivec2(dot(pixel - low, along), dot(high - pixel, along));
    bool is_low = lengths.x < lengths.y;
    // Towards the nearer end, the line cuts off a part of the pixels on one side of the edge only: of those that the change at this
    // end makes more like the neighbor.
    float change = is_low ? low_change : high_change;
    float cut = 0.5 - float(min(lengths.x, lengths.y)) / float(max(lengths.x + lengths.y, 1));
    if ((change < 0.0) == (middle < edge)) cut = 0.0;

    // A single pixel, or a thin line, differs from the mean around it (tent of 3 x 3 pixels without the middle).
    float around = (2.0 * (up + down + left + right) + up_left + up_right + down_left + down_right) / 12.0;
    float single = smoothstep(0.0, 1.0, saturate(abs(around - middle) / max(contrast, 1e-6)));
    float part = is_edge ? max(cut, single * single * fxaa_subpixel) : 0.0;

    vec4 smoothed = mix(here, pixel_at(pixel + across), part);
    vec4 unchanged = texelFetch(picture, pixel, 0);
    color = part > 0.0 ? vec4(smoothed.rgb / max(smoothed.a, 1e-6), smoothed.a) : unchanged;
}
