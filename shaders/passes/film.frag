//@pass film "Vignette and grain" to=picture after=fxaa off doc="Darker corners and the noise of a film"
#version 460
#include "pass.glsl"
#include "common/color.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"

// The look of a lens and a film: the cosine-fourth falloff of a thin lens (Kolb et al. 1995, "A Realistic Camera Model for Computer
// Graphics", section 4), and grain. It reads no time, so a still picture stays still.
//
// Limits: cos^4 is a thin lens without a hood; real ones also cut off the border of the aperture. The grain is white noise, finer than
// that of a film, and stands still in a moving picture too.

uniform sampler2D picture;

uniform Film {
    float film_vignette;       //@ui "Vignette" 0..1 = 0.5
    float film_grain;          //@ui "Grain" 0..1 = 0.25
};

void main() {
    vec4 scene = texture(picture, uv);
    // Illumination falls with cos^4 of the angle to the lens's axis: cos^2 = 1 / (1 + tan^2). At full strength the corners are at
    // 45 degrees, where a quarter is left.
    vec2 tangent = (uv - 0.5) * pass.size_px / length(0.5 * pass.size_px);
    float cos2 = 1.0 / (1.0 + film_vignette * dot(tangent, tangent));
    vec3 shown = srgb_from_linear(linear_from_srgb(scene.rgb) * cos2 * cos2);
    // Grain is strongest in middle tones: where every grain is exposed, or none, there is no noise. The sum of two random
    // numbers is closer to a normal distribution than a single number is.
    vec3 random = random_numbers(uvec3(gl_FragCoord.xy, 0u));
    float noise = random.x + random.y - 1.0;
    float tone = luma(shown);
    color = vec4(shown + film_grain * 0.25 * noise * sqrt(saturate(tone * (1.0 - tone))), scene.a);
}
