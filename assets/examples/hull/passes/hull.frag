//@pass hull "Hull outline" draw=model to=picture cull=front doc="The inside of the model's hull, a little larger than the model"
#version 460
#include "interface.glsl"
#include "common/fragment.glsl"

// An outline by the inverted hull: the model once more, grown along its normals, without the faces towards the camera. What is
// left of it lies behind the model and surrounds it.

uniform Hull {
    vec3 hull_color;     //@ui "Outline color" color = 0.02 0.02 0.05
    float hull_glow;     //@ui "Outline glow" 0..1 = 0.0
};

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;

void main() { color = vec4(hull_color * mix(1.0, 2000.0, hull_glow * hull_glow), 1.0); }
