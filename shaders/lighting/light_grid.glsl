// The lights that may reach a point, of any number of lights (clustered shading: Olsson, Billeter and Assarsson 2012).
//
//     LightWalk walk = lights_near(position_ws);
//     for (uint n = 0u; n < uint(MAX_LIGHTS); ++n) {
//         uint i = next_light(walk);
//         if (i == NO_LIGHT) break;
//         ... illuminate(light_at(i, position_ws), position_ws) ...
//     }
//
// A light that is left out is exactly 0 there: it is farther away than its range, or the point is outside of its cone. The order is the
// same in each frame: first the lights without an end, then the others. Up to FEW_LIGHTS lights, all of them come. Specula sorts the lights
// into boxes in world space (src/scene/light_grid.rs), so this works for any point in any stage.
#ifndef LIGHTING_LIGHT_GRID_GLSL
#define LIGHTING_LIGHT_GRID_GLSL

#include "interface.glsl"

struct LightGridWord {
    uint word;
};

// Words: the place of the list of each cell, x fastest, and the end of the last. Then the lists: numbers of lights in ascending order, and
// NO_LIGHT. The outermost cells have no end.
layout(set = SET_FRAME, binding = BINDING_LIGHT_GRID, scalar) readonly buffer LightGridWords {
    LightGrid light_grid;
    LightGridWord light_words[];
};

const uint NO_LIGHT = 0xffffffffu;

// The place of the list of a point's cell. The place after it is that of the next list.
uint light_cell(vec3 position_ws) {
    uvec3 cells = light_grid.cells;
    vec3 at = (position_ws - light_grid.min_ws) * light_grid.cells_per_m;
    uvec3 last = max(cells, uvec3(1u)) - 1u;
    // Twice, since a position that is no number may be any cell.
    uvec3 cell = min(uvec3(clamp(at, vec3(0.0), vec3(last))), last);
    return (cell.z * cells.y + cell.y) * cells.x + cell.x;
}

// The lists of a point, one after the other: of the lights for every point, and of its cell.
struct LightWalk {
    uint n;
    uint everywhere;
    uint everywhere_count;
    uint cell;
};

LightWalk lights_near(vec3 position_ws) {
    if (MANY_LIGHTS == 0u) return LightWalk(0u, 0u, 0u, 0u);
    uint cell = light_words[light_cell(position_ws)].word;
    return LightWalk(0u, light_grid.everywhere, light_grid.everywhere_count, cell);
}

// The next light, or NO_LIGHT. One read without a branch: a software device reads a buffer separately for each pixel.
uint next_light(inout LightWalk walk) {
    uint n = walk.n++;
    if (MANY_LIGHTS == 0u) return n < frame.light_count ? n : NO_LIGHT;
    uint place = n < walk.everywhere_count ? walk.everywhere + n : walk.cell + (n - walk.everywhere_count);
    return light_words[place].word;
}

#endif
