//@pass outline "Outline" to=picture after=tonemap off doc="A line where the depth of the model jumps"
#version 460
#include "pass.glsl"
#include "common/color.glsl"

// Draws lines where depth jumps. Depth is near / distance (reversed, 0 at infinity), which is linear over a plane on
// screen. So its second difference is 0 on a plane of any slope, and differs from 0 at an edge (Saito & Takahashi 1990,
// "Comprehensible Rendering of 3-D Shapes", section 4).
//
// Limits: it sees depth alone, so a crease or a change of material without a jump has no line. Blended surfaces have no depth.

uniform sampler2D picture;
uniform sampler2D depth;

uniform Outline {
    float outline_width;       //@ui "Outline width, pixels" 1..6 = 1.5
    float outline_threshold;   //@ui "Outline threshold" 0.001..0.2 = 0.02
    vec3 outline_color;        //@ui "Outline color" color = 0 0 0
};

void main() {
    vec2 far = outline_width / pass.size_px;
    float here = texture(depth, uv).r;
    vec2 x = vec2(texture(depth, uv - vec2(far.x, 0.0)).r, texture(depth, uv + vec2(far.x, 0.0)).r);
    vec2 y = vec2(texture(depth, uv - vec2(0.0, far.y)).r, texture(depth, uv + vec2(0.0, far.y)).r);
    float bend = max(abs(x.x + x.y - 2.0 * here), abs(y.x + y.y - 2.0 * here));
    // Relative to the nearest depth, so that a line does not depend on the distance. 1e-9: all may be 0, at infinity.
    float nearest = max(max(max(x.x, x.y), max(y.x, y.y)), max(here, 1e-9));
    float line = smoothstep(outline_threshold, 2.0 * outline_threshold, bend / nearest);
    vec4 scene = texture(picture, uv);
    color = vec4(mix(scene.rgb, srgb_from_linear(outline_color), line), max(scene.a, line));
}
