// Appended to a stage whose `main` was renamed. The module sets bits of `specula_check_bits`, or calls `specula_check_operands`: see
// spirv/checks/. Each check has six words of the buffer: how often it failed, the first place where it did, and operands. A fragment
// stage whose image has the size of the picture marks the pixels where a check fails, too.
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SpeculaChecks { uint words[]; };

SpeculaChecks specula_check_buffer() { return SpeculaChecks(uvec2(SPECULA_LOW, SPECULA_HIGH)); }

uint specula_check_bits[SPECULA_WORDS];
SPECULA_QUADS
bool specula_check_counts = false;

void specula_check_print(const in uint check, const in uvec4 bits) {
    if (check == 0u || !specula_check_counts) return;
    SpeculaChecks checks = specula_check_buffer();
    uint at = 6u * (check - 1u);
    if (checks.words[at + 1u] != SPECULA_PLACE) return;
    checks.words[at + 2u] = bits.x;
    checks.words[at + 3u] = bits.y;
    checks.words[at + 4u] = bits.z;
    checks.words[at + 5u] = bits.w;
}

void specula_check_operands(const in uint check, const in uvec4 bits) {
    if (check == 0u || !specula_check_counts) return;
    SPECULA_MARK;
    specula_check_print(check, bits);
}

void main() {
    specula_check_counts = SPECULA_COUNTS;
    SPECULA_QUADS_BEGIN
    // A function that is never called is left out of the module.
    specula_check_operands(0u, uvec4(0u));
    specula_check_print(0u, uvec4(0u));
    specula_main();
    SPECULA_QUADS_END
    if (!specula_check_counts) return;
    SpeculaChecks checks = specula_check_buffer();
    for (uint word = 0u; word < SPECULA_USED; word++) {
        uint bits = specula_check_bits[word];
        if (bits == 0u) continue;
        // Loops with a known end need no budget of rounds.
        for (uint bit = 0u; bit < 32u; bit++) {
            if ((bits >> bit & 1u) == 0u) continue;
            uint at = 6u * (32u * word + bit);
            atomicAdd(checks.words[at], 1u);
            atomicMin(checks.words[at + 1u], SPECULA_PLACE);
        }
    }
}
