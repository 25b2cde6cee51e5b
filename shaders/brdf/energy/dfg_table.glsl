// Lookups in the DFG table that depend on the selected D and V alone. Those that depend on F are in
// brdf/energy/albedo.glsl.
#ifndef BRDF_ENERGY_DFG_TABLE_GLSL
#define BRDF_ENERGY_DFG_TABLE_GLSL

#include "interface.glsl"
#include "brdf/energy/dfg.glsl"

layout(set = SET_FRAME, binding = BINDING_DFG) uniform sampler2D dfg_table;

vec4 dfg_texel(float cosine, float roughness, uint slice) {
    return textureLod(dfg_table, table_uv(cosine, roughness, slice, DFG_SIDE, DFG_SLICES), 0.0);
}

// E for v = n: the integral of D V NoL dl.
float facing_albedo(float roughness) { return texelFetch(dfg_table, fine_texel(roughness, DFG_MEAN), 0).r; }

// Roughness of the GGX whose facets spread as widely as those of the selected D: half of their area lies within tan =
// alpha (Walter et al. 2007, eq. 35). For formulas and tables that only exist for GGX (lighting/area.glsl).
float ggx_roughness(float roughness) {
    return min(roughness * sqrt(texelFetch(dfg_table, fine_texel(roughness, DFG_MEAN), 0).b), 1.0);
}

#endif
