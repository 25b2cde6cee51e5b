//@pass swarm "Swarm" draw=model to=picture instances=48 doc="Copies of the model that fly around it"
#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "lighting/environment.glsl"
#include "material/opaque.glsl"

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;

void main() {
    discard_holes(fragment);
    vec3 n = safe_normalize(fragment.normal_ws, vec3(0.0, 1.0, 0.0));
    vec3 v = safe_normalize(fragment.to_eye_ws, n);
    float fresnel = 0.04 + 0.96 * pow(1.0 - saturate(dot(n, v)), 5.0);
    vec3 radiance = fragment.color.rgb * irradiance_over_pi(n) + fresnel * prefiltered_radiance(reflect(-v, n), 0.3);
    color = vec4(radiance, 1.0);
}
