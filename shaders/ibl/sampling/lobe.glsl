// The directions in which the prefilter samples the two lobes of a pair of levels, 2 pair - 1 and 2 pair, whose maps have
// the same size (ibl/maps/levels.glsl). ibl/lobe.comp chooses them for the selected models; ibl/prefilter.comp reads
// them.
#ifndef IBL_SAMPLING_LOBE_GLSL
#define IBL_SAMPLING_LOBE_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "ibl/maps/levels.glsl"
#include "ibl/sampling/lobe_weight.glsl"

const uint LARGEST_LOBE = 512u;

struct LobeSample {
    vec3 direction;            // around +Z, unit
    float footprint;           // steradians that the sample represents
    vec2 weight;               // of the radiance there in the even and in the odd level, relative
};

struct Lobe {
    uint wrong;                // 1: D or V was NaN, infinite, negative or huge
    vec2 integral;             // of D V NoL dl, of both lobes
    LobeSample samples[LARGEST_LOBE];
};

// alpha of both lobes of a pair, from 1 on: that of the even level and of the odd one.
vec2 alpha_of_lobes(uint pair) {
    return vec2(lobe_alpha(roughness_of_specular_level(2.0 * float(pair))),
                lobe_alpha(roughness_of_specular_level(2.0 * float(pair) - 1.0)));
}

#endif
