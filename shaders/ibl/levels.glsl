// Which roughness a level of a prefiltered cube map holds: baking and looking up must agree.
#ifndef IBL_LEVELS_GLSL
#define IBL_LEVELS_GLSL

// Even steps from a mirror at level 0 to roughness 1 at the last level.
float roughness_of_level(uint level, uint levels) { return float(level) / float(max(levels, 2u) - 1u); }
float level_of_roughness(float roughness, int levels) { return roughness * float(levels - 1); }

#endif
