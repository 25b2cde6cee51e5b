// Maps roughness to levels of the prefiltered cube maps, for both the bake and the lookup.
#ifndef IBL_LEVELS_GLSL
#define IBL_LEVELS_GLSL

// The specular lobe. From level 0, a mirror, to level 10, roughness 1, each is 2^0.4 = 1.32 times as rough as the one
// before, since a mix of two lobes is off by the square of the logarithm of their ratio: 2.7 % of the light's contrast
// at most. Even levels are mip levels of one cube map, odd ones of another with half the side, so that levels 2 m - 1
// and 2 m have the same size. At roughness 1 that is 8 x 8 texels a face: with fewer, the sampler's interpolation is off
// by up to a tenth.
const float SPECULAR_LEVELS = 10.0;
float specular_level(float roughness) {
    float level = clamp(SPECULAR_LEVELS + 2.5 * log2(max(roughness, 1e-4)), 0.0, SPECULAR_LEVELS);
    // Between two levels, where the tails of the rougher lobe reach dark places, a little less of it is closer.
    float part = fract(level);
    return level - 0.12 * part * (1.0 - part);
}
float roughness_of_specular_level(float level) { return exp2(0.4 * (level - SPECULAR_LEVELS)); }

// Sheen. Roughness 1 is at the level with 8 x 8 texels a face. The smaller levels hold roughness 1 too; nothing looks
// them up.
const int LEVELS_LEFT = 3;
float last_level(int levels) { return float(max(levels - 1 - LEVELS_LEFT, 1)); }

// level / last = r (2 - r): denser at low roughness, where lobes change most.
float level_of_roughness(float roughness, int levels) { return last_level(levels) * roughness * (2.0 - roughness); }
float roughness_of_level(uint level, uint levels) {
    return 1.0 - sqrt(max(1.0 - float(level) / last_level(int(levels)), 0.0));
}

#endif
