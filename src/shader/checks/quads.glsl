// The invocations of the quad that have begun and do not run along at the moment, as four bits. See spirv/checks/derivatives.rs.
uvec4 specula_check_begun;
uint specula_check_quads[SPECULA_DERIVATIVES];

uint specula_check_quad(const in uvec4 ballot) {
    return ballot[gl_SubgroupInvocationID >> 5u] >> (gl_SubgroupInvocationID & 28u) & 15u;
}

uint specula_check_gone() {
    return specula_check_quad(specula_check_begun) & ~specula_check_quad(subgroupBallot(true));
}

// An invocation that was missing and is here took another way; one that is not here was discarded.
void specula_check_quads_end() {
    uint here = specula_check_quad(subgroupBallot(true));
    for (uint at = 0u; at < SPECULA_DERIVATIVES; at++) {
        uint quad = specula_check_quads[at];
        if ((quad & here & 15u) == 0u) continue;
        uint number = (quad >> 4u) - 1u;
        specula_check_bits[number >> 5u] |= 1u << (number & 31u);
    }
}
