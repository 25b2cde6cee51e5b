// Which roughness a level of a prefiltered cube map holds: baking and looking up must agree.
#ifndef IBL_LEVELS_GLSL
#define IBL_LEVELS_GLSL

// Roughness 1 is at the level with 8 x 8 texels a face: with fewer, what the sampler makes between their centers is off
// by up to a tenth. Those below it, which nothing looks up, hold roughness 1 too.
const int LEVELS_LEFT = 3;
float last_level(int levels) { return float(max(levels - 1 - LEVELS_LEFT, 1)); }

// level / last = r (2 - r): close together at low roughness, where lobes change most.
float level_of_roughness(float roughness, int levels) { return last_level(levels) * roughness * (2.0 - roughness); }
float roughness_of_level(uint level, uint levels) {
    return 1.0 - sqrt(max(1.0 - float(level) / last_level(int(levels)), 0.0));
}

#endif
