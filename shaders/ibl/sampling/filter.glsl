// Filtered importance sampling of a cube map (Krivanek & Colbert 2008): takes few samples and reads each at the mip
// level whose texels match the sample's solid angle. Together the samples cover the lobe without gaps, so there is no
// noise and there are no fireflies. All texels use the same samples around their axis; on a software device,
// recomputing them is faster than a table in shared memory.
#ifndef IBL_SAMPLING_FILTER_GLSL
#define IBL_SAMPLING_FILTER_GLSL

#include "interface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"

layout(set = SET_TASK, binding = BINDING_SOURCE_CUBE) uniform samplerCube source_cube;

// Solid angle of a texel of level 1 at the center of a face. Level 0 is not read, since it still has the small lights.
float finest_footprint() {
    float side = float(textureSize(source_cube, 1).x);
    return 4.0 / (side * side);
}

// Mean radiance of about `footprint` steradians around the unit vector d.
vec3 filtered_radiance(vec3 d, float footprint) {
    // `texels` is the footprint in texels of level 0. A texel's solid angle shrinks towards the corners of a face with
    // the cube of d's largest component, to a fifth.
    float side = float(textureSize(source_cube, 0).x);
    float major = max_component(abs(d));
    float texels = max(footprint * side * side / (4.0 * major * major * major), 4.0);
    // A texel of a level covers four of the level above. The finer of the two levels around the footprint is read alone: on a
    // software device, interpolating both would take half as long again.
    int level = ((floatBitsToInt(texels) >> 23) - 127) >> 1;   // floor(log4(texels)), from the exponent
    return textureLod(source_cube, d, float(level)).rgb;
}

// Variance of that filter along one axis, per unit of footprint: 1/12 for the box of a texel plus 1/6 for the tent of linear
// interpolation make 1/4 of the texel's area, which is between 1/4 and all of the footprint: 0.54 of it on average over all
// ratios. 0.17 instead of the product, 0.14, leaves the least error in the built-in environments.
const float FILTER_VARIANCE = 0.17;

#endif
