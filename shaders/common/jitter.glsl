// The offsets of frames for temporal antialiasing, see passes/temporal/temporal_mean.frag.
#ifndef COMMON_JITTER_GLSL
#define COMMON_JITTER_GLSL

#include "interface.glsl"

layout(constant_id = USER_CONSTANTS + 13) const bool TEMPORAL_ANTIALIASING = false;  //@ui "Temporal antialiasing" doc="Mean of many frames whose pixels are shifted by parts of a pixel: smooth edges and highlights"

// Frames until the offsets repeat.
const uint JITTERS = 16u;

// The digits of `i` in this base, mirrored at the point (van der Corput 1935): 0..1. The first five digits count.
float radical_inverse(uint i, uint base) {
    float result = 0.0;
    float digit = 1.0;
    for (int n = 0; n < 5; ++n) {
        digit /= float(base);
        result += digit * float(i % base);
        i /= base;
    }
    return result;
}

// How far the picture of the model is moved in this frame, pixels, -0.5..0.5: a point of the sequence in the bases 2 and 3
// (Halton 1960). Debug modes are not moved.
vec2 jitter_px() {
    if (!TEMPORAL_ANTIALIASING || frame.mode != 0u) return vec2(0.0);
    uint i = frame.frame_index % JITTERS + 1u;
    return vec2(radical_inverse(i, 2u), radical_inverse(i, 3u)) - 0.5;
}

#endif
