// Filtered importance sampling of a cube map (Krivanek & Colbert 2008): few samples, each read at the level whose
// texels are as large as the part of the sphere that the sample stands for. Together they cover the lobe without gaps:
// no noise, no fireflies. All texels take the same samples around their axis; a table of them in shared memory was
// slower on a software device than working them out again.
#ifndef IBL_FILTER_GLSL
#define IBL_FILTER_GLSL

#include "interface.glsl"
#include "common/math.glsl"

layout(set = SET_TASK, binding = BINDING_SOURCE_CUBE) uniform samplerCube source_cube;

// Turns of sample i around the axis: the golden ratio of a turn for each. On circles whose radii grow, such points are
// evenly spread whatever the radii are.
float golden_turns(uint i) { return fract(float(i) * 0.618033988); }

// Solid angle of a texel of level 1 in the middle of a face. Finer is not read: level 0 has the small lights.
float finest_footprint() {
    float side = float(textureSize(source_cube, 1).x);
    return 4.0 / (side * side);
}

// Mean radiance of about `footprint` steradians around d, a unit vector.
vec3 filtered_radiance(vec3 d, float footprint) {
    // In texels of level 0. They shrink towards a face's edges with the cube of d's largest component, to a fifth.
    float side = float(textureSize(source_cube, 0).x);
    float major = max_component(abs(d));
    float texels = max(footprint * side * side / (4.0 * major * major * major), 4.0);
    // A level's texels are four times the last one's. Between two levels it is the variance of the filter that counts,
    // so their areas are mixed, not their logarithms.
    float level = floor(0.5 * log2(texels));
    return textureLod(source_cube, d, level + (texels * exp2(-2.0 * level) - 1.0) / 3.0).rgb;
}

// Variance of that filter along an axis, for each unit of its area: 1/12 of the box of a texel, 1/6 of the tent between
// texels.
const float FILTER_VARIANCE = 0.25;

#endif
