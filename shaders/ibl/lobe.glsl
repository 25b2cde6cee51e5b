// The directions in which the prefilter samples a lobe, one list per level: ibl/lobe.comp chooses them for the selected
// NDF, ibl/prefilter.comp reads them.
#ifndef IBL_LOBE_GLSL
#define IBL_LOBE_GLSL

#include "interface.glsl"
#include "brdf/ndf.glsl"
#include "brdf/visibility.glsl"

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

// K = D V NoL of light that arrives at 1 - 2x to n = v, where x = sin^2 of the angle between n and h.
float lobe_weight(float x, float alpha) {
    float n_dot_l = 1.0 - 2.0 * x;
    return n_dot_l > 0.0 ? d_specular(sqrt(1.0 - x), x, alpha) * v_specular(n_dot_l, 1.0, alpha) * n_dot_l : 0.0;
}

// False for values that D and V must not have. They count as 0.
bool is_weight(float k) { return k >= 0.0 && k < 1e20; }

#endif
