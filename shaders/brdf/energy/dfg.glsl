// The moments of the specular lobe that lighting needs, for one direction or as a mean over directions. ibl/dfg.comp
// integrates them with the D, V and F that punctual lights use; brdf/energy/albedo.glsl looks them up.
//
// With c = VoH and integrals over all l, the lobe's albedo towards v is the integral of F(c) D V NoL dl. It splits in
// two ways:
//
//   Schlick's F    f_schlick(f0, f90, c) = f0 a(c) + f90 b(c), so the albedo is f0 A + f90 B, with A the integral of
//                  a D V NoL, and B that of b D V NoL. Exact for any f_schlick that is linear in f0 and f90.
//   any other F    known at five cosines c_j and interpolated between them: the albedo is the sum of F(c_j) W_j, with
//                  W_j the integral of L_j(c) D V NoL, and L_j the interpolating functions below.
#ifndef BRDF_ENERGY_DFG_GLSL
#define BRDF_ENERGY_DFG_GLSL

struct Dfg {
    float a;                   // A
    float b;                   // B
    float e;                   // E, the albedo for F = 1: the integral of D V NoL, and the sum of all W_j
    float lost;                // 1 - E / N, at least 0: what masking and shadowing take from the lobe
    vec4 weights;              // W_j of F_COSINES; that of c = 1 is E minus their sum
};

// The cosines at which F is sampled, and c = 1. F varies most at grazing angles. L_j spans 1, x^2, x^5, c x^6 and x^12,
// x = 1 - c. So Schlick's curve and F82 are exact; the exact equations are off by at most 0.001 for dielectrics of index
// 1.1 to 2.4, and 0.006 for metals (gold, aluminum, copper, iron, titanium, tungsten).
const vec4 F_COSINES = vec4(0.0, 0.07, 0.25, 0.55);

// L_j of F_COSINES at c: the inverse of the matrix of the spanning functions at the five cosines. 1 - sum is L of c = 1.
vec4 f_weights(float c) {
    float x = 1.0 - c;
    float x2 = x * x;
    float x4 = x2 * x2;
    vec4 terms = vec4(x2, x4 * x, c * x4 * x2, x4 * x4 * x4);
    const mat4 L = mat4(-0.0855484, 0.2785587, -0.9954906, 6.9362293,
                        -5.8178049, 15.1374389, -16.3950102, 9.6179126,
                        27.1951993, -73.2796738, 110.1191024, -127.198047,
                        6.9033533, -15.4159976, 17.3905008, -16.5541419);
    return L * terms;
}

// Their cosine-weighted means, 2 integral L_j(c) c dc, which average F: within 0.0003 for the exact dielectric equations.
const vec4 F_MEAN_WEIGHTS = vec4(0.00039955, 0.01626559, 0.11843567, 0.42261210);

// Tables are images of SLICES stacked maps. Columns are the square root of the cosine, rows are roughness, each 0 in the first
// and 1 in the last texel of a slice: no lookup leaves its slice.
const uint DFG_SIDE = 128u;
const uint DFG_DIRECTION = 0u;           // a, b, e, lost
const uint DFG_DIRECTION_WEIGHTS = 1u;   // weights
const uint DFG_MEAN = 2u;                // e along the normal; mean b; width of D (ggx_roughness); mean lost; fine rows, see below
const uint DFG_MEAN_WEIGHTS = 3u;
const uint DFG_LOBE = 4u;                // mean of e, DFG_FLAG bits of wrong values; fine rows
const uint DFG_SLICES = 5u;
const uint DFG_FLAG_D = 1u;              // D was NaN, infinite, negative or huge somewhere
const uint DFG_FLAG_V = 2u;
const uint DFG_FLAG_F = 4u;
const uint DIFFUSE_SIDE = 64u;
const uint DIFFUSE_COLORS = 0u;          // albedo over base color, for base colors of 1/3, 2/3 and 1; flag
const uint DIFFUSE_WEIGHTS = 1u;         // weights of F_COSINES over the half vectors of the diffuse lobe
const uint DIFFUSE_SLICES = 2u;
const uint SHEEN_SIDE = 64u;

// The cosine of a column and the place of a cosine, 0..1 across the table. Albedo is steep where the cosine is below alpha, so
// half of the columns are below a cosine of 1/4. With columns of equal cosines, a white metal gained up to 7 % beyond 85
// degrees.
float cosine_of_column(uint column, uint side) {
    float root = float(column) / float(side - 1u);
    return root * root;
}
float column_of_cosine(float cosine, uint side) { return (sqrt(cosine) * float(side - 1u) + 0.5) / float(side); }

// Slices that do not depend on the angle store 16,257 steps of roughness instead, enough that the nearest one is as precise
// as the half floats themselves. Reading one texel is cheaper than interpolating four. Rust interpolates the steps between
// the rows that ibl/dfg.comp writes.
ivec2 fine_texel(float roughness, uint slice) {
    int last = int(DFG_SIDE * (DFG_SIDE - 1u));
    int i = clamp(int(roughness * float(last) + 0.5), 0, last);
    return ivec2(i % int(DFG_SIDE), int(slice * DFG_SIDE) + i / int(DFG_SIDE));
}

vec2 table_uv(float cosine, float roughness, uint slice, uint side, uint slices) {
    float row = float(slice * side) + roughness * float(side - 1u) + 0.5;
    return vec2(column_of_cosine(cosine, side), row / float(slices * side));
}

#endif
