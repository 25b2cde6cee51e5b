// Appended to a stage whose `main` was renamed. The module calls `specula_trace` with each value, and `specula_trace_enter` and
// `specula_trace_leave` where a function begins and ends: see spirv/trace/. The log holds the number of invocations, three numbers that say
// which are logged, and a part for each: see log.rs, which also replaces the words in capitals.
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SpeculaLog { uint words[]; };

SpeculaLog specula_trace_log() { return SpeculaLog(uvec2(SPECULA_LOW, SPECULA_HIGH)); }

// The first word of the invocation's part, or 0: it is not logged.
uint specula_trace_part = 0u;
// Events and calls so far, and the number of the call that is under way, from 1.
uint specula_trace_events = 0u;
uint specula_trace_calls = 0u;
uint specula_trace_call = 0u;

// The first events of a point stay. Behind them, each event replaces the oldest one. `STORE` writes the value.
#define SPECULA_TRACE(NAME, STORE) \
    void NAME(const in uint point, const in uvec4 bits) { \
        if (specula_trace_part != 0u) { \
            SpeculaLog log = specula_trace_log(); \
            uint counter = specula_trace_part + SPECULA_HEADER + point; \
            uint number = log.words[counter]; \
            log.words[counter] = number + 1u; \
            uint slot = number < SPECULA_KEPT ? number : SPECULA_KEPT + (number & SPECULA_MASK); \
            uint at = specula_trace_part + SPECULA_FIRST_EVENT + SPECULA_STRIDE * point + 6u * slot; \
            log.words[at] = specula_trace_events; \
            log.words[at + 1u] = specula_trace_call; \
            STORE \
            specula_trace_events += 1u; \
        } \
    }
#define SPECULA_X log.words[at + 2u] = bits.x;
#define SPECULA_XY SPECULA_X log.words[at + 3u] = bits.y;
#define SPECULA_XYZ SPECULA_XY log.words[at + 4u] = bits.z;
#define SPECULA_XYZW SPECULA_XYZ log.words[at + 5u] = bits.w;

// One for each number of values: each store costs compile time wherever it is inlined.
SPECULA_TRACE(specula_trace, SPECULA_XYZW)
SPECULA_TRACE(specula_trace_1, SPECULA_X)
SPECULA_TRACE(specula_trace_2, SPECULA_XY)
SPECULA_TRACE(specula_trace_3, SPECULA_XYZ)

// Returns the call that was under way.
uint specula_trace_enter(const in uint point, const in uint light) {
    uint caller = specula_trace_call;
    if (specula_trace_part != 0u) {
        SpeculaLog log = specula_trace_log();
        uint number = specula_trace_calls;
        uint slot = number < SPECULA_CALLS ? number : SPECULA_CALLS + number % SPECULA_CALLS;
        uint at = specula_trace_part + SPECULA_FIRST_CALL + 3u * slot;
        log.words[at] = caller;
        log.words[at + 1u] = point;
        log.words[at + 2u] = light;
        log.words[specula_trace_part + SPECULA_HEADER + point] += 1u;
        specula_trace_calls = number + 1u;
        specula_trace_call = number + 1u;
        log.words[specula_trace_part + 6u] = number + 1u;
    }
    return caller;
}

void specula_trace_leave(const in uint caller) { specula_trace_call = caller; }

void specula_trace_begin() {
    // Functions that are never called are left out of the module. These calls log nothing.
    specula_trace(0u, uvec4(0u));
    specula_trace_1(0u, uvec4(0u));
    specula_trace_2(0u, uvec4(0u));
    specula_trace_3(0u, uvec4(0u));
    specula_trace_leave(specula_trace_enter(0u, 0u));
    SpeculaLog log = specula_trace_log();
    uvec3 logged = uvec3(log.words[1], log.words[2], log.words[3]);
    if (!(SPECULA_IS_LOGGED)) return;
    // Fragments of one pixel may run at the same time, as may vertices.
    uint place = atomicAdd(log.words[0], 1u);
    if (place >= SPECULA_FRAGMENTS) return;
    specula_trace_part = 4u + place * SPECULA_PART;
    log.words[specula_trace_part] = SPECULA_NUMBER;
    log.words[specula_trace_part + 7u] = SPECULA_SAMPLES;
    log.words[specula_trace_part + 8u] = SPECULA_PRIMITIVE;
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
