// Appended to a stage whose `main` was renamed, to record what its functions return: see spirv/cost/. The buffer has six words for the
// stage and for each function: how many calls, in how many invocations, the invocation with a call that is nearest to the middle of the
// picture, the one whose results are kept, and where those are.
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer SpeculaCosts { uint words[]; };

// A variable each, which the optimizer makes values of: a driver would take minutes to compile arrays.
SPECULA_DECLARED


void specula_cost_end() {
    if (!(SPECULA_COUNTS)) return;
    SpeculaCosts costs = SpeculaCosts(uvec2(SPECULA_LOW, SPECULA_HIGH));
    uint counts[SPECULA_SLOTS] = uint[](SPECULA_ALL_COUNTS);
    uvec4 values[SPECULA_GROUPS] = uvec4[](SPECULA_ALL_VALUES);
    uint key = SPECULA_KEY;
    for (uint slot = 0u; slot < SPECULA_SLOTS; slot++) {
        uint count = counts[slot];
        if (count == 0u) continue;
        uint at = 6u * slot;
        atomicAdd(costs.words[at], count);
        atomicAdd(costs.words[at + 1u], 1u);
        atomicMin(costs.words[at + 2u], key);
        if (costs.words[at + 3u] != key) continue;
        uint first = costs.words[at + 4u];
        // A function has at most 16 groups of numbers. Loops with a known end need no budget of rounds.
        for (uint group = 0u; group < 16u; group++) {
            if (group >= costs.words[at + 5u]) continue;
            uvec4 numbers = values[min(first + group, SPECULA_GROUPS - 1u)];
            uint to = SPECULA_NUMBERS + 4u * (first + group);
            costs.words[to] = numbers.x;
            costs.words[to + 1u] = numbers.y;
            costs.words[to + 2u] = numbers.z;
            costs.words[to + 3u] = numbers.w;
        }
    }
}

void main() {
    specula_cost_count_0 = 1u;
    specula_main();
    specula_cost_end();
}
