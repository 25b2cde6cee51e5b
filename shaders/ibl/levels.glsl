// Maps roughness to levels of a prefiltered cube map, for both the bake and the lookup.
#ifndef IBL_LEVELS_GLSL
#define IBL_LEVELS_GLSL

// Roughness 1 is at the level with 8 x 8 texels a face: with fewer, the sampler's interpolation is off by up to a
// tenth. The smaller levels hold roughness 1 too; nothing looks them up.
const int LEVELS_LEFT = 3;
float last_level(int levels) { return float(max(levels - 1 - LEVELS_LEFT, 1)); }

// level / last = r (2 - r): denser at low roughness, where lobes change most.
float level_of_roughness(float roughness, int levels) { return last_level(levels) * roughness * (2.0 - roughness); }
float roughness_of_level(uint level, uint levels) {
    return 1.0 - sqrt(max(1.0 - float(level) / last_level(int(levels)), 0.0));
}

#endif
