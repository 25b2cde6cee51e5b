// The directions in which the prefilter samples two lobes, an even level's and that of the odd level before, which have
// the same size: ibl/lobe.comp chooses them for the selected models, ibl/prefilter.comp reads them.
#ifndef IBL_LOBE_GLSL
#define IBL_LOBE_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "ibl/levels.glsl"
#include "ibl/lobe_weight.glsl"

const uint LARGEST_LOBE = 512u;
const uint LOBE_LEVELS = 8u;

struct LobeSample {
    float x;                   // sin^2 of the angle between n and h; the cosine to l is 1 - 2x
    float footprint;           // steradians that the sample represents
    vec2 weight;               // of the radiance there in the even and in the odd level, relative
};

struct Lobe {
    uint wrong;                // 1: D or V was NaN, infinite, negative or huge
    vec2 integral;             // of D V NoL dl, of both lobes
    LobeSample samples[LARGEST_LOBE];
};

layout(set = SET_TASK, binding = BINDING_LOBES, scalar) buffer Lobes { Lobe lobes[LOBE_LEVELS]; };

// alpha of both lobes of mip level `mip`, at least 1. 0.999: at alpha = 1, GGX is flat.
vec2 alpha_of_lobes(uint mip) {
    float even = alpha_from_roughness(roughness_of_specular_level(2.0 * float(mip)));
    float odd = alpha_from_roughness(roughness_of_specular_level(2.0 * float(mip) - 1.0));
    return min(vec2(even, odd), 0.999);
}

#endif
