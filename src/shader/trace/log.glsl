// Appended to a stage whose `main` was renamed. The module calls `specula_trace` with each value: see spirv/trace/. The log holds the
// number of fragments, the pixel, and a part for each fragment: see log.rs.
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SpeculaLog { uint words[]; };

SpeculaLog specula_trace_log() { return SpeculaLog(uvec2(SPECULA_LOW, SPECULA_HIGH)); }

// The first word of the fragment's part, or 0: this is another pixel.
uint specula_trace_part = 0u;
uint specula_trace_count = 0u;

void specula_trace(const in uint point, const in uvec4 bits) {
    if (specula_trace_part != 0u) {
        SpeculaLog log = specula_trace_log();
        if (specula_trace_count < SPECULA_EVENTS) {
            uint at = specula_trace_part + SPECULA_HEADER + SPECULA_POINTS + 5u * specula_trace_count;
            log.words[at] = point;
            log.words[at + 1u] = bits.x;
            log.words[at + 2u] = bits.y;
            log.words[at + 3u] = bits.z;
            log.words[at + 4u] = bits.w;
        } else {
            // The log is full: this only counts.
            log.words[specula_trace_part + SPECULA_HEADER + point % SPECULA_POINTS] += 1u;
        }
        specula_trace_count += 1u;
    }
}

void specula_trace_begin() {
    // A function that is never called is left out of the module. This call logs nothing.
    specula_trace(0u, uvec4(0u));
    SpeculaLog log = specula_trace_log();
    if (gl_HelperInvocation || uvec2(gl_FragCoord.xy) != uvec2(log.words[1], log.words[2])) return;
    uint fragment = atomicAdd(log.words[0], 1u);
    if (fragment >= SPECULA_FRAGMENTS) return;
    specula_trace_part = 4u + fragment * SPECULA_PART;
    log.words[specula_trace_part] = floatBitsToUint(gl_FragCoord.z);
}

void specula_trace_end(const in vec4 color) {
    if (specula_trace_part == 0u) return;
    SpeculaLog log = specula_trace_log();
    log.words[specula_trace_part + 1u] = 1u;
    log.words[specula_trace_part + 2u] = floatBitsToUint(color.x);
    log.words[specula_trace_part + 3u] = floatBitsToUint(color.y);
    log.words[specula_trace_part + 4u] = floatBitsToUint(color.z);
    log.words[specula_trace_part + 5u] = floatBitsToUint(color.w);
}

void main() {
    specula_trace_begin();
    specula_main();
    specula_trace_end(SPECULA_COLOR);
}
