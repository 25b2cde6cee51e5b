//@pass ground "Ground" to=picture off doc="The model's shadow on the ground under it"
#version 460
#include "pass.glsl"
#include "lighting/shadows/ground.glsl"

// Darkens the background where the model takes light from the ground, by the part of the irradiance that is left. The ground
// itself is not drawn, and reflects no light onto the model.

uniform sampler2D picture;
uniform sampler2D depth;
uniform sampler2D ground_light;

uniform Ground {
    float ground_strength;     //@ui "Ground shadow" 0..1 = 0.8
};

void main() {
    vec4 scene = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
    color = scene;
    vec4 far = frame.world_from_clip * vec4(2.0 * uv - 1.0, 0.0, 1.0);
    vec3 direction = far.xyz - far.w * frame.eye_ws;
    float above = frame.eye_ws.y - ground_height();
    if (texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r > 0.0 || direction.y >= 0.0 || above <= 0.0) return;
    vec3 position_ws = frame.eye_ws - direction * (above / direction.y);
    float away = length(position_ws.xz - frame.scene_center_ws.xz) / (0.5 * ground_width());
    float fade = ground_strength * (1.0 - smoothstep(0.6, 1.0, away));
    vec3 left = mix(vec3(1.0), textureLod(ground_light, ground_uv(position_ws), 0.0).rgb, fade);
    // Where no environment is behind the model, the shadow is black with the coverage of what it takes away.
    float taken = 1.0 - max(left.r, max(left.g, left.b));
    color = vec4(scene.rgb * left, scene.a + (1.0 - min(scene.a, 1.0)) * taken);
}
