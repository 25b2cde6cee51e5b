//@pass ground "Ground" draw=background to=picture blend off doc="The model's shadow on the ground under it"
#version 460
#include "interface.glsl"
#include "common/color.glsl"
#include "common/math.glsl"
#include "lighting/shadows/ground.glsl"

// A shadow catcher (compare the differential rendering of Debevec 1998, "Rendering Synthetic Objects into Real Scenes"): darkens what
// lies behind the model where the model takes light from the ground, by the part of the luminance that is left. The
// ground itself is not drawn, and reflects no light onto the model. Where nothing lies behind the model, its shadow is black with
// the coverage of what it takes away.
//
// Limits: the shadow is gray, also under lights of different colors.

uniform sampler2D ground_light;

uniform Ground {
    float ground_strength;     //@ui "Ground shadow" 0..1 = 1.0
};

layout(location = 0) in vec3 position_ws;
layout(location = 0) out vec4 color;

void main() {
    float away = length(position_ws.xz - frame.scene_center_ws.xz) / (0.5 * ground_width());
    float fade = ground_strength * (1.0 - smoothstep(0.6, 1.0, away));
    float left = luminance(textureLod(ground_light, ground_uv(position_ws), 0.0).rgb);
    color = vec4(0.0, 0.0, 0.0, fade * saturate(1.0 - left));
}
