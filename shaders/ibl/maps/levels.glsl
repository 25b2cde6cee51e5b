// Maps roughness to the prefiltered levels and each level to its place, for both the bake and the lookup.
#ifndef IBL_MAPS_LEVELS_GLSL
#define IBL_MAPS_LEVELS_GLSL

#include "interface.glsl"
#include "ibl/maps/octahedral.glsl"

// The specular lobe. Level 0 is a mirror, and level SPECULAR_LEVELS has roughness 1. Each level is 2^(1/4) times as rough
// as the one before.
float specular_level(float roughness) {
    return clamp(float(SPECULAR_LEVELS) + 4.0 * log2(max(roughness, 1e-4)), 0.0, float(SPECULAR_LEVELS));
}
float roughness_of_specular_level(float level) { return exp2(0.25 * (level - float(SPECULAR_LEVELS))); }

// Radiance between two levels a and b, at the fraction t: about their weighted geometric mean, a^(1-t) b^t. Under a light that
// is smaller than the lobe, a level shows the lobe itself. GGX is proportional to 1 / alpha^2 at its peak and to alpha^2 in
// its tail, so the geometric mean of two is the lobe between them in both places, and off by at most 3 % in its flanks.
// The arithmetic mean is 6 % too bright at peak and tail. Where the levels hardly differ, all means are the same.
//
// a^(1-t) b^t = m - t (1 - t) (a - b)^2 / (a + b) + third-order terms of log(a / b), with m = mix(a, b, t); never negative.
// The sums of the channels stand for a, b and m, so that the color is that of the mix. 1e-30: two black levels.
vec3 between_levels(vec3 a, vec3 b, float t) {
    vec3 mixed = mix(a, b, t);
    float sum_a = a.r + a.g + a.b;
    float sum_b = b.r + b.g + b.b;
    float difference = sum_a - sum_b;
    float mean = mixed.r + mixed.g + mixed.b;
    return mixed - mixed * (t * (1.0 - t) * difference * difference / max((sum_a + sum_b) * mean, 1e-30));
}

// All levels are octahedral maps in one image. The mirror is at the top. Below it are rows 1, 2, ... of two levels: the odd
// one at the left, the even one after it, of the same size, at half the width. A row is 3/4 as high as the one above, so
// its place is a geometric series.
const float ROW_RATIO = 0.75;

// The height of a row relative to the first: ROW_RATIO^(row - 1).
float scale_of_row(float row) { return exp2(-0.41503750 * (row - 1.0)); }

Tile tile_in_row(float left, float scale) {
    float top = float(MIRROR_SIDE) + float(SPECULAR_SIDE) / (1.0 - ROW_RATIO) * (1.0 - scale);
    return Tile(vec2(left, top), float(SPECULAR_SIDE) * scale);
}

// The tile of level 2 row - 1.
Tile odd_tile(float scale) { return tile_in_row(0.0, scale); }

// The tile of level 2 row. Selections instead of a branch: they cost a software device less.
Tile even_tile(float row, float scale) {
    Tile tile = tile_in_row(float(SPECULAR_SIDE), scale);
    return Tile(row > 0.0 ? tile.corner : vec2(0.0), row > 0.0 ? tile.side : float(MIRROR_SIDE));
}

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
