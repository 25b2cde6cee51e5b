//@pass depth_of_field "Depth of field" to=picture after=temporal off doc="Blurs what a lens does not focus"
#version 460
#include "pass.glsl"
#include "common/pixel.glsl"

// Depth of field of a thin lens (dof_circle.frag), gathered at half the size in two layers, as Hammon 2007, "Practical Post-Process
// Depth of Field" (GPU Gems 3, chapter 28), and Jimenez 2014, "Next Generation Post Processing in Call of Duty: Advanced Warfare", do.
// The part behind the focus blurs within its own edges (dof_far_raw.frag). What is in front of it also blurs over what is behind
// (dof_near_raw.frag).
//
// Limits: behind a blurred foreground the picture is guessed from around it; what shows through glass, or in a mirror, is as blurred
// as the surface; blur ends at 1/32 of the picture's height.

uniform sampler2D picture;
uniform sampler2D dof_circle;
uniform sampler2D dof_far;
uniform sampler2D dof_near;

void main() {
    vec4 scene = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
    float blur = abs(texelFetch(dof_circle, ivec2(gl_FragCoord.xy), 0).r);
    float coverage = coverage_of(scene.a);
    vec4 light = mix(vec4(scene.rgb, coverage), texture(dof_far, uv), smoothstep(0.5, 2.0, blur));
    vec4 near = texture(dof_near, uv);
    light = near + (1.0 - near.a) * light;
    // Flags stay as they are.
    color = vec4(light.rgb, light.a + (scene.a - coverage));
}
