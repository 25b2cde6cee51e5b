// Appended to a stage whose `main` was renamed. The module calls `specula_trace` with each value: see spirv/trace/. The log holds the
// number of invocations, three numbers that say which are logged, and a part for each: see log.rs, which also replaces the words in
// capitals.
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SpeculaLog { uint words[]; };

SpeculaLog specula_trace_log() { return SpeculaLog(uvec2(SPECULA_LOW, SPECULA_HIGH)); }

// The first word of the invocation's part, or 0: it is not logged.
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
    uvec3 logged = uvec3(log.words[1], log.words[2], log.words[3]);
    if (!(SPECULA_IS_LOGGED)) return;
    uint place = atomicAdd(log.words[0], 1u);
    if (place >= SPECULA_FRAGMENTS) return;
    specula_trace_part = 4u + place * SPECULA_PART;
    log.words[specula_trace_part] = SPECULA_NUMBER;
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
    specula_trace_end(SPECULA_RESULT);
}
