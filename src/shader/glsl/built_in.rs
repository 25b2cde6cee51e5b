//! The built-in names of GLSL: functions, types and variables that a shader is likely to use. With them `assert` and `print`, which Specula adds.

/// A name of the language.
#[derive(Clone, Copy, Debug)]
pub struct BuiltIn {
    /// The name.
    pub name: &'static str,
    /// Its forms: `genType` is float or a vector of floats, `genIType` and `genUType` the same of int and uint, `gvec4` a vec4, ivec4 or uvec4.
    /// Empty for a type or a constant.
    pub forms: &'static [&'static str],
    /// One sentence.
    pub doc: &'static str,
}

impl BuiltIn {
    /// Whether it is called.
    pub fn is_function(&self) -> bool {
        self.forms.first().is_some_and(|form| form.contains('('))
    }

    /// The type of the value, as the first form has it; a type itself for a type.
    pub fn type_name(&self) -> &'static str {
        self.forms.first().map_or(self.name, |form| form.split(' ').next().unwrap_or_default())
    }
}

/// The built-in name, if it is one.
pub fn built_in(name: &str) -> Option<&'static BuiltIn> {
    BUILT_IN.iter().find(|known| known.name == name)
}

/// Whether a word means something in GLSL itself, so that nothing else can have this name.
pub fn is_reserved(word: &str) -> bool {
    let is_type = || BUILT_IN.iter().any(|known| known.name == word && known.forms.is_empty());
    KEYWORDS.contains(&word) || word.starts_with("gl_") || word.contains("__") || is_type()
}

/// The words of the language that are no names.
#[rustfmt::skip]
pub const KEYWORDS: &[&str] = &[
    "if", "else", "for", "while", "do", "switch", "case", "default", "break", "continue", "return", "discard", "struct", "const", "in", "out",
    "inout", "uniform", "buffer", "shared", "layout", "flat", "smooth", "noperspective", "centroid", "sample", "patch", "invariant", "precise",
    "highp", "mediump", "lowp", "precision", "coherent", "volatile", "restrict", "readonly", "writeonly", "void", "true", "false", "attribute",
    "varying", "subroutine", "common", "partition", "active", "asm", "class", "union", "enum", "typedef", "template", "this", "resource", "goto",
    "inline", "noinline", "public", "static", "extern", "external", "interface", "long", "short", "half", "fixed", "unsigned", "superp", "input",
    "output", "filter", "sizeof", "cast", "namespace", "using", "double", "dvec2", "dvec3", "dvec4",
];

const fn of(name: &'static str, forms: &'static [&'static str], doc: &'static str) -> BuiltIn {
    BuiltIn { name, forms, doc }
}

/// All of them.
#[rustfmt::skip]
pub const BUILT_IN: &[BuiltIn] = &[
    of("radians", &["genType radians(genType degrees)"], "Degrees to radians."),
    of("degrees", &["genType degrees(genType radians)"], "Radians to degrees."),
    of("sin", &["genType sin(genType angle)"], "The sine of an angle in radians."),
    of("cos", &["genType cos(genType angle)"], "The cosine of an angle in radians."),
    of("tan", &["genType tan(genType angle)"], "The tangent of an angle in radians."),
    of("asin", &["genType asin(genType x)"], "The angle -pi/2..pi/2 whose sine is x. Undefined if |x| > 1."),
    of("acos", &["genType acos(genType x)"], "The angle 0..pi whose cosine is x. Undefined if |x| > 1."),
    of("atan", &["genType atan(genType y, genType x)", "genType atan(genType y_over_x)"], "The angle whose tangent is y / x; with two arguments in all four quadrants, -pi..pi. Undefined if x and y are 0."),
    of("sinh", &["genType sinh(genType x)"], "The hyperbolic sine."),
    of("cosh", &["genType cosh(genType x)"], "The hyperbolic cosine."),
    of("tanh", &["genType tanh(genType x)"], "The hyperbolic tangent."),
    of("asinh", &["genType asinh(genType x)"], "The inverse of sinh."),
    of("acosh", &["genType acosh(genType x)"], "The inverse of cosh that is not negative. Undefined if x < 1."),
    of("atanh", &["genType atanh(genType x)"], "The inverse of tanh. Undefined if |x| >= 1."),
    of("pow", &["genType pow(genType x, genType y)"], "x to the power of y. Undefined if x < 0, or if x = 0 and y <= 0."),
    of("exp", &["genType exp(genType x)"], "e to the power of x."),
    of("log", &["genType log(genType x)"], "The natural logarithm. Undefined if x <= 0."),
    of("exp2", &["genType exp2(genType x)"], "2 to the power of x."),
    of("log2", &["genType log2(genType x)"], "The logarithm to the base 2. Undefined if x <= 0."),
    of("sqrt", &["genType sqrt(genType x)"], "The square root. Undefined if x < 0."),
    of("inversesqrt", &["genType inversesqrt(genType x)"], "1 / sqrt(x). Undefined if x <= 0."),
    of("abs", &["genType abs(genType x)", "genIType abs(genIType x)"], "x without its sign."),
    of("sign", &["genType sign(genType x)", "genIType sign(genIType x)"], "1, 0 or -1 as x is positive, 0 or negative."),
    of("floor", &["genType floor(genType x)"], "The largest whole number that is not larger than x."),
    of("trunc", &["genType trunc(genType x)"], "x without its fraction."),
    of("round", &["genType round(genType x)"], "The nearest whole number; halves go either way."),
    of("roundEven", &["genType roundEven(genType x)"], "The nearest whole number; halves go to the even one."),
    of("ceil", &["genType ceil(genType x)"], "The smallest whole number that is not smaller than x."),
    of("fract", &["genType fract(genType x)"], "x - floor(x)."),
    of("mod", &["genType mod(genType x, genType y)", "genType mod(genType x, float y)"], "x - y * floor(x / y)."),
    of("modf", &["genType modf(genType x, out genType whole)"], "The fraction of x; its whole part goes to the second argument."),
    of("min", &["genType min(genType x, genType y)", "genType min(genType x, float y)", "genIType min(genIType x, genIType y)", "genUType min(genUType x, genUType y)"], "The smaller of two values."),
    of("max", &["genType max(genType x, genType y)", "genType max(genType x, float y)", "genIType max(genIType x, genIType y)", "genUType max(genUType x, genUType y)"], "The larger of two values."),
    of("clamp", &["genType clamp(genType x, genType low, genType high)", "genType clamp(genType x, float low, float high)", "genIType clamp(genIType x, genIType low, genIType high)", "genUType clamp(genUType x, genUType low, genUType high)"], "min(max(x, low), high). Undefined if low > high."),
    of("mix", &["genType mix(genType x, genType y, genType a)", "genType mix(genType x, genType y, float a)", "genType mix(genType x, genType y, genBType a)"], "x * (1 - a) + y * a; with bools, y where a is true."),
    of("step", &["genType step(genType edge, genType x)", "genType step(float edge, genType x)"], "0 if x < edge, else 1."),
    of("smoothstep", &["genType smoothstep(genType low, genType high, genType x)", "genType smoothstep(float low, float high, genType x)"], "0 to 1 between low and high, smooth at both ends. Undefined if low >= high."),
    of("isnan", &["genBType isnan(genType x)"], "Whether x is no number."),
    of("isinf", &["genBType isinf(genType x)"], "Whether x is infinite."),
    of("fma", &["genType fma(genType a, genType b, genType c)"], "a * b + c, rounded once where it is `precise`."),
    of("frexp", &["genType frexp(genType x, out genIType exponent)"], "The significand of x, 0.5..1; its exponent goes to the second argument."),
    of("ldexp", &["genType ldexp(genType x, genIType exponent)"], "x * 2^exponent."),
    of("floatBitsToInt", &["genIType floatBitsToInt(genType x)"], "The bits of a float as an int."),
    of("floatBitsToUint", &["genUType floatBitsToUint(genType x)"], "The bits of a float as a uint."),
    of("intBitsToFloat", &["genType intBitsToFloat(genIType x)"], "The float with these bits."),
    of("uintBitsToFloat", &["genType uintBitsToFloat(genUType x)"], "The float with these bits."),
    of("packUnorm2x16", &["uint packUnorm2x16(vec2 v)"], "Two numbers 0..1 as 16 bits each."),
    of("packSnorm2x16", &["uint packSnorm2x16(vec2 v)"], "Two numbers -1..1 as 16 bits each."),
    of("packUnorm4x8", &["uint packUnorm4x8(vec4 v)"], "Four numbers 0..1 as 8 bits each."),
    of("packSnorm4x8", &["uint packSnorm4x8(vec4 v)"], "Four numbers -1..1 as 8 bits each."),
    of("packHalf2x16", &["uint packHalf2x16(vec2 v)"], "Two numbers as half floats."),
    of("unpackUnorm2x16", &["vec2 unpackUnorm2x16(uint p)"], "The inverse of packUnorm2x16."),
    of("unpackSnorm2x16", &["vec2 unpackSnorm2x16(uint p)"], "The inverse of packSnorm2x16."),
    of("unpackUnorm4x8", &["vec4 unpackUnorm4x8(uint p)"], "The inverse of packUnorm4x8."),
    of("unpackSnorm4x8", &["vec4 unpackSnorm4x8(uint p)"], "The inverse of packSnorm4x8."),
    of("unpackHalf2x16", &["vec2 unpackHalf2x16(uint p)"], "The inverse of packHalf2x16."),
    of("length", &["float length(genType v)"], "The length of a vector."),
    of("distance", &["float distance(genType a, genType b)"], "The distance of two points."),
    of("dot", &["float dot(genType a, genType b)"], "The sum of the products of the components."),
    of("cross", &["vec3 cross(vec3 a, vec3 b)"], "A vector perpendicular to both, by the right hand."),
    of("normalize", &["genType normalize(genType v)"], "The vector of length 1 in the same direction. Undefined if v is 0."),
    of("faceforward", &["genType faceforward(genType n, genType incident, genType reference)"], "n if dot(reference, incident) < 0, else -n."),
    of("reflect", &["genType reflect(genType incident, genType n)"], "incident - 2 * dot(n, incident) * n; n is unit."),
    of("refract", &["genType refract(genType incident, genType n, float eta)"], "The refracted direction, 0 at total reflection. eta: index before over index behind; both vectors are unit."),
    of("matrixCompMult", &["mat matrixCompMult(mat a, mat b)"], "The product of two matrices component by component."),
    of("outerProduct", &["mat outerProduct(vec column, vec row)"], "The matrix column * transposed row."),
    of("transpose", &["mat transpose(mat m)"], "Rows become columns."),
    of("determinant", &["float determinant(mat m)"], "The determinant of a square matrix."),
    of("inverse", &["mat inverse(mat m)"], "The inverse of a square matrix. Undefined if there is none."),
    of("lessThan", &["bvec lessThan(vec x, vec y)"], "x < y, component by component."),
    of("lessThanEqual", &["bvec lessThanEqual(vec x, vec y)"], "x <= y, component by component."),
    of("greaterThan", &["bvec greaterThan(vec x, vec y)"], "x > y, component by component."),
    of("greaterThanEqual", &["bvec greaterThanEqual(vec x, vec y)"], "x >= y, component by component."),
    of("equal", &["bvec equal(vec x, vec y)"], "x == y, component by component."),
    of("notEqual", &["bvec notEqual(vec x, vec y)"], "x != y, component by component."),
    of("any", &["bool any(bvec x)"], "Whether a component is true."),
    of("all", &["bool all(bvec x)"], "Whether all components are true."),
    of("not", &["bvec not(bvec x)"], "The components negated."),
    of("bitfieldExtract", &["genIType bitfieldExtract(genIType value, int offset, int bits)", "genUType bitfieldExtract(genUType value, int offset, int bits)"], "Bits of a value, from the offset on."),
    of("bitfieldInsert", &["genIType bitfieldInsert(genIType base, genIType insert, int offset, int bits)"], "A value with other bits, from the offset on."),
    of("bitfieldReverse", &["genUType bitfieldReverse(genUType value)"], "The bits in reverse order."),
    of("bitCount", &["genIType bitCount(genUType value)"], "The number of bits that are 1."),
    of("findLSB", &["genIType findLSB(genUType value)"], "The place of the lowest bit that is 1; -1 if there is none."),
    of("findMSB", &["genIType findMSB(genUType value)"], "The place of the highest bit that is 1; -1 if there is none."),
    of("texture", &["gvec4 texture(gsampler image, vec place)", "gvec4 texture(gsampler image, vec place, float bias)", "float texture(samplerShadow image, vec place)"], "A texel of an image, filtered. Needs the neighboring pixels for its mip level."),
    of("textureLod", &["gvec4 textureLod(gsampler image, vec place, float level)"], "A texel of a given mip level."),
    of("textureGrad", &["gvec4 textureGrad(gsampler image, vec place, vec dx, vec dy)"], "A texel with given derivatives of the place."),
    of("textureOffset", &["gvec4 textureOffset(gsampler image, vec place, ivec offset)"], "A texel some texels beside a place; the offset is constant."),
    of("textureProj", &["gvec4 textureProj(gsampler image, vec place)"], "A texel at a place divided by its last component."),
    of("textureGather", &["gvec4 textureGather(gsampler image, vec place)", "gvec4 textureGather(gsampler image, vec place, int component)"], "One component of the four texels around a place."),
    of("textureSize", &["ivec textureSize(gsampler image, int level)"], "The size of a mip level, texels."),
    of("textureQueryLod", &["vec2 textureQueryLod(gsampler image, vec place)"], "The mip level that texture() would read."),
    of("textureQueryLevels", &["int textureQueryLevels(gsampler image)"], "The number of mip levels."),
    of("texelFetch", &["gvec4 texelFetch(gsampler image, ivec texel, int level)"], "A texel by its number, unfiltered. Undefined outside of the image."),
    of("texelFetchOffset", &["gvec4 texelFetchOffset(gsampler image, ivec texel, int level, ivec offset)"], "A texel beside another one."),
    of("imageLoad", &["gvec4 imageLoad(gimage image, ivec texel)"], "A texel of a storage image."),
    of("imageStore", &["void imageStore(gimage image, ivec texel, gvec4 value)"], "Writes a texel of a storage image."),
    of("imageSize", &["ivec imageSize(gimage image)"], "The size of a storage image, texels."),
    of("atomicAdd", &["uint atomicAdd(inout uint memory, uint value)", "int atomicAdd(inout int memory, int value)"], "Adds to memory. Returns the value before."),
    of("atomicMin", &["uint atomicMin(inout uint memory, uint value)"], "Stores the smaller value. Returns the value before."),
    of("atomicMax", &["uint atomicMax(inout uint memory, uint value)"], "Stores the larger value. Returns the value before."),
    of("atomicAnd", &["uint atomicAnd(inout uint memory, uint value)"], "Bitwise and. Returns the value before."),
    of("atomicOr", &["uint atomicOr(inout uint memory, uint value)"], "Bitwise or. Returns the value before."),
    of("atomicXor", &["uint atomicXor(inout uint memory, uint value)"], "Bitwise exclusive or. Returns the value before."),
    of("atomicExchange", &["uint atomicExchange(inout uint memory, uint value)"], "Stores a value. Returns the value before."),
    of("atomicCompSwap", &["uint atomicCompSwap(inout uint memory, uint compare, uint value)"], "Stores a value if memory equals `compare`. Returns the value before."),
    of("dFdx", &["genType dFdx(genType p)"], "The change of p to the pixel on the right. Fragment stages only."),
    of("dFdy", &["genType dFdy(genType p)"], "The change of p to the next row. Fragment stages only."),
    of("fwidth", &["genType fwidth(genType p)"], "abs(dFdx(p)) + abs(dFdy(p))."),
    of("dFdxFine", &["genType dFdxFine(genType p)"], "dFdx by the pixel's own neighbor."),
    of("dFdyFine", &["genType dFdyFine(genType p)"], "dFdy by the pixel's own neighbor."),
    of("fwidthFine", &["genType fwidthFine(genType p)"], "fwidth by the pixel's own neighbors."),
    of("dFdxCoarse", &["genType dFdxCoarse(genType p)"], "dFdx, the same for four pixels."),
    of("dFdyCoarse", &["genType dFdyCoarse(genType p)"], "dFdy, the same for four pixels."),
    of("fwidthCoarse", &["genType fwidthCoarse(genType p)"], "fwidth, the same for four pixels."),
    of("barrier", &["void barrier()"], "Waits for all invocations of the workgroup."),
    of("memoryBarrier", &["void memoryBarrier()"], "Orders accesses of memory."),
    of("memoryBarrierShared", &["void memoryBarrierShared()"], "Orders accesses of shared variables."),
    of("groupMemoryBarrier", &["void groupMemoryBarrier()"], "Orders accesses of memory within the workgroup."),
    of("SetMeshOutputsEXT", &["void SetMeshOutputsEXT(uint vertices, uint primitives)"], "The number of vertices and primitives that the workgroup gives. Mesh stages only."),
    of("EmitMeshTasksEXT", &["void EmitMeshTasksEXT(uint x, uint y, uint z)"], "Starts mesh workgroups. Task stages only."),
    of("EmitVertex", &["void EmitVertex()"], "Adds a vertex with the current outputs. Geometry stages only."),
    of("EndPrimitive", &["void EndPrimitive()"], "Ends the current strip. Geometry stages only."),
    of("assert", &["void assert(bool condition)", "void assert(bool condition, text message)"], "Fails `specula check MODEL` and `render` where the condition does not hold. Costs nothing in the window. The message stands in quotes."),
    of("print", &["void print(text name, value)"], "Tells a value in `specula check MODEL` and `render`. The name stands in quotes."),
    of("float", &[], "A number with 24 bits of precision."),
    of("int", &[], "A whole number of 32 bits."),
    of("uint", &[], "A whole number of 32 bits that is not negative."),
    of("bool", &[], "true or false."),
    of("vec2", &[], "Two floats."),
    of("vec3", &[], "Three floats."),
    of("vec4", &[], "Four floats."),
    of("ivec2", &[], "Two ints."),
    of("ivec3", &[], "Three ints."),
    of("ivec4", &[], "Four ints."),
    of("uvec2", &[], "Two uints."),
    of("uvec3", &[], "Three uints."),
    of("uvec4", &[], "Four uints."),
    of("bvec2", &[], "Two bools."),
    of("bvec3", &[], "Three bools."),
    of("bvec4", &[], "Four bools."),
    of("mat2", &[], "Two columns of two floats."),
    of("mat3", &[], "Three columns of three floats."),
    of("mat4", &[], "Four columns of four floats."),
    of("mat4x3", &[], "Four columns of three floats."),
    of("mat3x2", &[], "Three columns of two floats."),
    of("mat2x3", &[], "Two columns of three floats."),
    of("mat2x4", &[], "Two columns of four floats."),
    of("mat3x4", &[], "Three columns of four floats."),
    of("mat4x2", &[], "Four columns of two floats."),
    of("image2D", &[], "A storage image."),
    of("image2DArray", &[], "Layers of storage images."),
    of("image3D", &[], "A storage image of three dimensions."),
    of("uimage2D", &[], "A storage image of uints."),
    of("usampler2D", &[], "An image of uints."),
    of("isampler2D", &[], "An image of ints."),
    of("sampler2DShadow", &[], "An image of depths, which are compared."),
    of("sampler2D", &[], "An image, read with filters."),
    of("sampler3D", &[], "An image of three dimensions."),
    of("samplerCube", &[], "Six images around a point, read by a direction."),
    of("sampler2DArray", &[], "Layers of images."),
    of("sampler2DMS", &[], "An image with several samples in each pixel."),
    of("true", &[], "The bool that holds."),
    of("false", &[], "The bool that does not hold."),
    of("gl_FragCoord", &["vec4 gl_FragCoord"], "xy: the pixel's center from the upper left corner; z: depth; w: 1 / w of clip space. Fragment stages."),
    of("gl_FrontFacing", &["bool gl_FrontFacing"], "Whether the front of the triangle is seen. Fragment stages."),
    of("gl_PointCoord", &["vec2 gl_PointCoord"], "The place within a point, 0..1. Fragment stages."),
    of("gl_PrimitiveID", &["int gl_PrimitiveID"], "The number of the triangle in its draw."),
    of("gl_FragDepth", &["float gl_FragDepth"], "The depth that the fragment writes. Fragment stages."),
    of("gl_VertexIndex", &["int gl_VertexIndex"], "The number of the vertex. Vertex stages."),
    of("gl_InstanceIndex", &["int gl_InstanceIndex"], "The number of the instance. Vertex stages."),
    of("gl_Position", &["vec4 gl_Position"], "The vertex in clip space."),
    of("gl_PointSize", &["float gl_PointSize"], "The size of a point, pixels."),
    of("gl_InvocationID", &["int gl_InvocationID"], "The number of the invocation. Tessellation control and geometry stages."),
    of("gl_TessCoord", &["vec3 gl_TessCoord"], "The place in the patch. Tessellation evaluation stages."),
    of("gl_GlobalInvocationID", &["uvec3 gl_GlobalInvocationID"], "The invocation's place in the whole dispatch. Compute stages."),
    of("gl_LocalInvocationID", &["uvec3 gl_LocalInvocationID"], "The invocation's place in its workgroup. Compute stages."),
    of("gl_LocalInvocationIndex", &["uint gl_LocalInvocationIndex"], "The number of the invocation in its workgroup. Compute stages."),
    of("gl_WorkGroupID", &["uvec3 gl_WorkGroupID"], "The workgroup's place. Compute stages."),
    of("gl_NumWorkGroups", &["uvec3 gl_NumWorkGroups"], "The number of workgroups. Compute stages."),
    of("gl_WorkGroupSize", &["uvec3 gl_WorkGroupSize"], "The size of a workgroup. Compute stages."),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_is_one_of_its_name() {
        for known in BUILT_IN {
            let has_name = |form: &&&str| form.split(['(', ' ']).nth(1) == Some(known.name);
            assert!(known.forms.iter().all(|form| has_name(&form)) && known.doc.ends_with('.'), "{known:?}");
            assert_eq!(BUILT_IN.iter().filter(|other| other.name == known.name).count(), 1, "{known:?}");
        }
        assert!(
            is_reserved("vec3")
                && is_reserved("gl_Any")
                && is_reserved("for")
                && !is_reserved("mix")
                && !is_reserved("alpha")
        );
        assert_eq!((built_in("dot").unwrap().type_name(), built_in("vec3").unwrap().type_name()), ("float", "vec3"));
        assert!(built_in("dot").unwrap().is_function() && !built_in("gl_Position").unwrap().is_function());
    }
}
