//@pass temporal_mean "Temporal antialiasing: mean" keep when=TEMPORAL_ANTIALIASING doc="Mean of the last frames, each seen from the newest camera: light, exposed and compressed to 0..1, and (1 + coverage) / 2"
#version 460
#include "pass.glsl"
#include "common/jitter.glsl"
#include "common/pixel.glsl"
#include "passes/temporal/compress.glsl"

// Each frame samples the pixels at other points, and their mean over some frames is a smooth picture. A pixel finds its mean
// where its surface was one frame before (reverse reprojection: Nehab et al. 2007). Variance clipping: history outside of
// 1.25 standard deviations of the 3 x 3 pixels around it, in YCoCg, is probably another surface, so it is pulled back to that
// range (Karis 2014, "High-Quality Temporal Supersampling"; Salvi 2016, "An Excursion in Temporal Supersampling").
//
// The depth says where a still surface was, exactly; own_motion.frag says it of one that a pose has moved, once a pixel.
//
// Limits: a surface that user_vertex moves is looked for where it is now. Reflections move with their surface.

uniform sampler2D picture;
uniform sampler2D depth;
uniform sampler2D own_motion;
uniform sampler2D before_temporal_mean;

uniform Temporal {
    float temporal_newest;     //@ui "Temporal antialiasing: newest frame" 0.02..1 = 0.1
};

const float DEVIATIONS = 1.25;

// Brightness, orange minus blue, green minus purple (Malvar & Sullivan 2003); w stays.
vec4 ycocg_from_rgb(vec4 c) {
    return vec4(0.25 * c.r + 0.5 * c.g + 0.25 * c.b, 0.5 * (c.r - c.b), 0.5 * c.g - 0.25 * (c.r + c.b), c.w);
}

vec4 rgb_from_ycocg(vec4 c) { return vec4(c.x + c.y - c.z, c.x + c.z, c.x - c.y - c.z, c.w); }

// Light and coverage of a pixel of this frame.
vec4 newest_at(ivec2 pixel) {
    vec4 scene = texelFetch(picture, pixel, 0);
    return ycocg_from_rgb(vec4(compress(scene.rgb), coverage_of(scene.a)));
}

// The mean of the frame before, interpolated by Catmull-Rom splines, which stay sharp. The four corners, whose weights are
// small, are left out, and bilinear samples fetch pairs of texels.
vec4 mean_before(vec2 at_px) {
    vec2 center = floor(at_px - 0.5) + 0.5;
    vec2 part = at_px - center;
    vec2 w0 = part * (-0.5 + part * (1.0 - 0.5 * part));
    vec2 w1 = 1.0 + part * part * (-2.5 + 1.5 * part);
    vec2 w3 = part * part * (-0.5 + 0.5 * part);
    vec2 w12 = 1.0 - w0 - w3;
    vec2 low = (center - 1.0) / pass.size_px;
    vec2 middle = (center + (w12 - w1) / w12) / pass.size_px;
    vec2 high = (center + 2.0) / pass.size_px;
    vec4 sum = texture(before_temporal_mean, middle) * w12.x * w12.y;
    sum += texture(before_temporal_mean, vec2(low.x, middle.y)) * w0.x * w12.y;
    sum += texture(before_temporal_mean, vec2(high.x, middle.y)) * w3.x * w12.y;
    sum += texture(before_temporal_mean, vec2(middle.x, low.y)) * w12.x * w0.y;
    sum += texture(before_temporal_mean, vec2(middle.x, high.y)) * w12.x * w3.y;
    return sum / (w12.x * w12.y + (w0.x + w3.x) * w12.y + w12.x * (w0.y + w3.y));
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 last = ivec2(pass.size_px) - 1;
    vec4 newest = vec4(0.0);
    vec4 sum = vec4(0.0);
    vec4 squares = vec4(0.0);
    // The nearest surface decides where the pixel was, so that edges move with what is in front.
    vec3 nearest = vec3(0.0, 0.0, -1.0);
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            ivec2 at = clamp(pixel + ivec2(x, y), ivec2(0), last);
            vec4 value = newest_at(at);
            sum += value;
            squares += value * value;
            if (x == 0 && y == 0) newest = value;
            float near = texelFetch(depth, at, 0).r;
            if (near > nearest.z) nearest = vec3(vec2(at - pixel), near);
        }
    }
    // The jitter has moved this frame's picture, so the surface is seen at the pixel less the jitter.
    vec2 ndc = 2.0 * (gl_FragCoord.xy + nearest.xy - jitter_px()) / pass.size_px - 1.0;
    vec4 before = frame.clip_from_world_before * (frame.world_from_clip * vec4(ndc, nearest.z, 1.0));
    vec2 motion_px = 0.5 * pass.size_px * (before.xy / before.w - ndc);
    vec4 own = texelFetch(own_motion, clamp(pixel + ivec2(nearest.xy), ivec2(0), last), 0);
    if (own.a == 1.0) motion_px = -own.rg * pass.size_px;
    vec2 before_px = gl_FragCoord.xy + motion_px;

    // Alpha is 0 in an image that was never drawn.
    vec4 mean = mean_before(before_px);
    bool is_outside = any(lessThan(before_px, vec2(0.0))) || any(greaterThan(before_px, pass.size_px)) || before.w <= 0.0;
    vec4 center = sum / 9.0;
    vec4 reach = DEVIATIONS * sqrt(max(squares / 9.0 - center * center, 0.0)) + 1e-5;
    vec4 offset = ycocg_from_rgb(vec4(mean.rgb, 2.0 * mean.a - 1.0)) - center;
    vec4 beyond = abs(offset) / reach;
    vec4 kept = center + offset / max(max(max(beyond.x, beyond.y), max(beyond.z, beyond.w)), 1.0);
    float weight = is_outside || mean.a < 0.25 ? 1.0 : temporal_newest;
    vec4 result = max(rgb_from_ycocg(mix(kept, newest, weight)), 0.0);
    color = vec4(result.rgb, 0.5 + 0.5 * result.a);
}
