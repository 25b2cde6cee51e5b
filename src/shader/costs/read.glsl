// Appended to a stage whose `main` was renamed, to draw it without a function: see spirv/cost/. In place of its body, the function reads
// the numbers that it has returned at a pixel.
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer SpeculaCostNumbers { uvec4 numbers[]; };

uvec4 specula_cost_read(const in uint index) {
    // glslang crashes where a member of the reference is read without a variable.
    SpeculaCostNumbers results = SpeculaCostNumbers(uvec2(SPECULA_LOW, SPECULA_HIGH));
    return results.numbers[index];
}

void main() {
    // A function that is never called is left out of the module.
    specula_cost_read(0u);
    specula_main();
}
