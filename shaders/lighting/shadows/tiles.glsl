// The shadow map is an image with a tile for each of the first MAX_LIGHT_VIEWS lights, suns of the environment after the others.
// The rest throws no shadow.
#ifndef LIGHTING_TILES_GLSL
#define LIGHTING_TILES_GLSL

#include "interface.glsl"

// Side of the shadow map, pixels: the size in passes/shadows/shadow_map.frag. textureSize takes longer on a software device.
const float SHADOW_MAP_PX = 2048.0;

// Tiles in a row of the shadow map, and rows.
uint shadow_tiles() {
    uint lights = (LIGHT_COUNT != 0u ? LIGHT_COUNT : frame.light_count) + SUN_COUNT;
    return lights <= 1u ? 1u : lights <= 4u ? 2u : lights <= 9u ? 3u : 4u;
}

// Corner of the light's tile in the map, 0..1: the least u and v.
vec2 shadow_tile(uint light) { return vec2(light % shadow_tiles(), light / shadow_tiles()) / float(shadow_tiles()); }

#endif
