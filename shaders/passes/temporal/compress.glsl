// Light for temporal means: exposed and compressed, so that a single bright sample does not outweigh all others (Karis 2014).
#ifndef PASSES_TEMPORAL_COMPRESS_GLSL
#define PASSES_TEMPORAL_COMPRESS_GLSL

#include "interface.glsl"

// Light in cd/m^2, times coverage, to 0..1.
vec3 compress(vec3 light) {
    vec3 exposed = max(light * frame.exposure, 0.0);
    return exposed / (1.0 + max(exposed.r, max(exposed.g, exposed.b)));
}

// The inverse of `compress`. Half floats near 1 are 1 / 2048 apart, so light beyond 4096 times white is cut off.
vec3 expand(vec3 value) {
    vec3 exposed = value / max(1.0 - max(value.r, max(value.g, value.b)), 1.0 / 4096.0);
    return min(exposed / frame.exposure, frame.largest_value);
}

#endif
