// The directions in which the prefilter samples a lobe, one list per level: ibl/lobe.comp chooses them for the selected
// NDF, ibl/prefilter.comp reads them.
#ifndef IBL_LOBE_GLSL
#define IBL_LOBE_GLSL

#include "interface.glsl"

const uint LARGEST_LOBE = 512u;
const uint LOBE_LEVELS = 16u;

struct LobeSample {
    float x;                   // sin^2 of the angle between n and h; the cosine to l is 1 - 2x
    float footprint;           // steradians that the sample represents
    float weight;              // of the radiance there, relative
};

struct Lobe {
    float integral;            // of D NoL dl
    uint wrong;                // 1: D was NaN, infinite or negative
    LobeSample samples[LARGEST_LOBE];
};

layout(set = SET_TASK, binding = BINDING_LOBES, scalar) buffer Lobes { Lobe lobes[LOBE_LEVELS]; };

#endif
