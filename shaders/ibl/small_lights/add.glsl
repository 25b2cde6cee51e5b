// The list of small lights, for the stages that add them to a filtered mean.
#ifndef IBL_SMALL_LIGHTS_ADD_GLSL
#define IBL_SMALL_LIGHTS_ADD_GLSL

#include "interface.glsl"
#include "ibl/small_lights/list.glsl"

// A uniform block: a software device reads a storage buffer separately for each invocation of a group.
layout(set = SET_TASK, binding = BINDING_SMALL_LIGHTS, scalar) uniform SmallLights { SmallLightList listed; };

uint listed_lights() { return min(listed.count, LARGEST_COUNT); }

#endif
