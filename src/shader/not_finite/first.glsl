// Appended to a stage whose `main` was renamed. The module calls `specula_trace` with each value: see spirv/trace/.
// Each: the place, and the classes of the value's components, two bits each: 0 finite, 1 NaN, 2 infinity, 3 minus infinity.
uvec2 specula_first, specula_first_nan;

void specula_trace(const in uint place, const in uvec4 bits) {
    uvec4 magnitude = bits & 0x7fffffffu;
    uvec4 infinite = uvec4(equal(magnitude, uvec4(0x7f800000u)));
    uvec4 nan = uvec4(greaterThan(magnitude, uvec4(0x7f800000u)));
    uvec4 classes = (nan + infinite * (2u + (bits >> 31u))) << uvec4(0u, 2u, 4u, 6u);
    uvec2 event = uvec2(place, classes.x | classes.y | classes.z | classes.w);
    specula_first = event.y != 0u && specula_first.x == 0u ? event : specula_first;
    specula_first_nan = (nan.x | nan.y | nan.z | nan.w) != 0u && specula_first_nan.x == 0u ? event : specula_first_nan;
}

vec4 specula_traced() {
    specula_trace(0u, uvec4(0u));
    return specula_first.x == 0u ? vec4(0.0)
        : vec4(specula_first.x, specula_first_nan.x, SPECULA_MARK + specula_first.y, 1.0);
}
