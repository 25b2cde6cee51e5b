// The list of small lights, for the stages that add them to a filtered mean.
#ifndef IBL_LISTED_LIGHTS_GLSL
#define IBL_LISTED_LIGHTS_GLSL

#include "interface.glsl"
#include "ibl/small_lights.glsl"

// A uniform block: a software device reads a storage buffer separately for each invocation of a group.
layout(set = SET_TASK, binding = BINDING_SMALL_LIGHTS, scalar) uniform SmallLights { SmallLightList listed; };

uint listed_lights() { return min(listed.count, LARGEST_COUNT); }

#endif
