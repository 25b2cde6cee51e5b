// Light for temporal means: exposed and compressed, so that a single bright sample does not outweigh all others (Karis 2014).
#ifndef PASSES_TEMPORAL_COMPRESS_GLSL
#define PASSES_TEMPORAL_COMPRESS_GLSL

#include "interface.glsl"

// Light in cd/m^2, times coverage, to 0..1.
vec3 compress(vec3 light) {
    vec3 exposed = max(light * frame.exposure, 0.0);
    return exposed / (1.0 + max(exposed.r, max(exposed.g, exposed.b)));
}

// The inverse of `compress`.
vec3 expand(vec3 value) {
    return value / max((1.0 - max(value.r, max(value.g, value.b))) * frame.exposure, 1e-12);
}

#endif
