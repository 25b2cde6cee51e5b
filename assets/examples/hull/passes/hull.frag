//@pass hull "Hull outline" draw=model to=picture cull=front doc="The inside of the model's hull, a little larger than the model"
#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "material/opaque.glsl"

// An outline by the inverted hull: the model once more, grown along its normals, without the faces towards the camera. What is
// left of it lies behind the model and surrounds it.

uniform Hull {
    vec3 hull_color;     //@ui "Hull color" color = 1 0.35 0.05
};

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;

// The color as it is exposed, whatever the exposure is.
void main() {
    discard_holes(fragment);
    color = vec4(hull_color / frame.exposure, 1.0);
}
