//! The SPIR-V capabilities that a module may use: those that need no device feature, and those whose feature Specula
//! always enables. See the Vulkan specification, appendix "Vulkan Environment for SPIR-V".

/// The capabilities that every shader may use. `gpu::device` enables the features among them.
const AVAILABLE: &[u32] = &[
    0,    // Matrix
    1,    // Shader
    2,    // Geometry: geometry stages, gl_PrimitiveID in fragment shaders
    3,    // Tessellation: `pipeline::limits` asks the device
    23,   // TessellationPointSize: the same
    24,   // GeometryPointSize: the same
    35,   // SampleRateShading: `pipeline::limits` asks the device
    40,   // InputAttachment
    43,   // Sampled1D
    44,   // Image1D
    46,   // SampledBuffer
    47,   // ImageBuffer
    50,   // ImageQuery: textureSize, textureQueryLevels
    51,   // DerivativeControl: dFdxFine
    61,   // GroupNonUniform: subgroupElect
    5283, // MeshShadingEXT: `pipeline::limits` asks the device
    5301, // ShaderNonUniform
    5347, // PhysicalStorageBufferAddresses: buffer_reference
];

/// A capability that Specula does not enable.
#[derive(Debug, PartialEq, Eq)]
pub struct Missing {
    /// Its name in SPIR-V, or its number.
    pub name: String,
    /// GLSL words that may require it. The error points at the first one in the text.
    pub glsl: &'static [&'static str],
}

/// The capabilities of a module that Specula does not enable.
pub fn missing(capabilities: &[u32]) -> Vec<Missing> {
    let unavailable = capabilities.iter().filter(|number| !AVAILABLE.contains(number));
    let named = |number: &u32| match KNOWN.iter().find(|(known, ..)| known == number) {
        Some((_, name, glsl)) => Missing { name: (*name).to_owned(), glsl },
        None => Missing { name: number.to_string(), glsl: &[] },
    };
    unavailable.map(named).collect()
}

/// Capabilities that GLSL for Vulkan may require, and the words that require them.
const KNOWN: &[(u32, &str, &[&str])] = &[
    (9, "Float16", &["float16_t", "f16vec2", "f16vec3", "f16vec4", "f16mat3", "f16mat4"]),
    (10, "Float64", &["double", "dvec2", "dvec3", "dvec4", "dmat2", "dmat3", "dmat4", "float64_t"]),
    (11, "Int64", &["int64_t", "uint64_t", "i64vec2", "i64vec3", "i64vec4", "u64vec2", "u64vec3", "u64vec4"]),
    (12, "Int64Atomics", &["atomicAdd", "atomicMin", "atomicMax", "atomicExchange", "atomicCompSwap"]),
    (22, "Int16", &["int16_t", "uint16_t", "i16vec2", "i16vec3", "i16vec4", "u16vec2", "u16vec3", "u16vec4"]),
    (25, "ImageGatherExtended", &["textureGatherOffset", "textureGatherOffsets"]),
    (27, "StorageImageMultisample", &["image2DMS", "image2DMSArray"]),
    (28, "UniformBufferArrayDynamicIndexing", &[]),
    (29, "SampledImageArrayDynamicIndexing", &[]),
    (30, "StorageBufferArrayDynamicIndexing", &[]),
    (31, "StorageImageArrayDynamicIndexing", &[]),
    (32, "ClipDistance", &["gl_ClipDistance"]),
    (33, "CullDistance", &["gl_CullDistance"]),
    (34, "ImageCubeArray", &["imageCubeArray"]),
    (39, "Int8", &["int8_t", "uint8_t", "i8vec2", "i8vec3", "i8vec4", "u8vec2", "u8vec3", "u8vec4"]),
    (41, "SparseResidency", &["sparseTextureARB"]),
    (42, "MinLod", &["textureClampARB"]),
    (45, "SampledCubeArray", &["samplerCubeArray", "samplerCubeArrayShadow", "textureCubeArray"]),
    (48, "ImageMSArray", &["image2DMSArray"]),
    (
        49,
        "StorageImageExtendedFormats",
        &["rg16f", "rg32f", "r16f", "rg8", "r8", "r11f_g11f_b10f", "rgb10_a2", "rgba16", "rg16", "r16"],
    ),
    (52, "InterpolationFunction", &["interpolateAtCentroid", "interpolateAtSample", "interpolateAtOffset"]),
    (54, "GeometryStreams", &["EmitStreamVertex", "EndStreamPrimitive", "stream"]),
    (55, "StorageImageReadWithoutFormat", &["imageLoad"]),
    (56, "StorageImageWriteWithoutFormat", &["imageStore"]),
    (57, "MultiViewport", &["gl_ViewportIndex"]),
    (62, "GroupNonUniformVote", &["subgroupAll", "subgroupAny", "subgroupAllEqual"]),
    (63, "GroupNonUniformArithmetic", &["subgroupAdd", "subgroupMul", "subgroupMin", "subgroupMax"]),
    (64, "GroupNonUniformBallot", &["subgroupBallot", "subgroupBroadcast", "subgroupBroadcastFirst"]),
    (65, "GroupNonUniformShuffle", &["subgroupShuffle", "subgroupShuffleXor"]),
    (66, "GroupNonUniformShuffleRelative", &["subgroupShuffleUp", "subgroupShuffleDown"]),
    (67, "GroupNonUniformClustered", &["subgroupClusteredAdd", "subgroupClusteredMin", "subgroupClusteredMax"]),
    (68, "GroupNonUniformQuad", &["subgroupQuadBroadcast", "subgroupQuadSwapHorizontal", "subgroupQuadSwapVertical"]),
    (69, "ShaderLayer", &["gl_Layer"]),
    (70, "ShaderViewportIndex", &["gl_ViewportIndex"]),
    (4422, "FragmentShadingRateKHR", &["gl_ShadingRateEXT", "gl_PrimitiveShadingRateEXT"]),
    (4427, "DrawParameters", &["gl_BaseVertex", "gl_BaseInstance", "gl_DrawID"]),
    (4433, "StorageBuffer16BitAccess", &["float16_t", "int16_t", "uint16_t"]),
    (4434, "UniformAndStorageBuffer16BitAccess", &["float16_t", "int16_t", "uint16_t"]),
    (4435, "StoragePushConstant16", &["float16_t", "int16_t", "uint16_t"]),
    (4436, "StorageInputOutput16", &["float16_t", "int16_t", "uint16_t"]),
    (4439, "MultiView", &["gl_ViewIndex"]),
    (4448, "StorageBuffer8BitAccess", &["int8_t", "uint8_t"]),
    (4449, "UniformAndStorageBuffer8BitAccess", &["int8_t", "uint8_t"]),
    (4472, "RayQueryKHR", &["rayQueryEXT", "rayQueryInitializeEXT"]),
    (5013, "StencilExportEXT", &["gl_FragStencilRefARB"]),
    (5055, "ShaderClockKHR", &["clockARB", "clock2x32ARB", "clockRealtimeEXT", "clockRealtime2x32EXT"]),
    (5254, "ShaderViewportIndexLayerEXT", &["gl_Layer", "gl_ViewportIndex"]),
    (5284, "FragmentBarycentricKHR", &["gl_BaryCoordEXT", "gl_BaryCoordNoPerspEXT", "pervertexEXT"]),
    (5291, "FragmentDensityEXT", &["gl_FragSizeEXT", "gl_FragInvocationCountEXT"]),
    (5302, "RuntimeDescriptorArray", &["nonuniformEXT"]),
    (5306, "UniformBufferArrayNonUniformIndexing", &["nonuniformEXT"]),
    (5307, "SampledImageArrayNonUniformIndexing", &["nonuniformEXT"]),
    (5308, "StorageBufferArrayNonUniformIndexing", &["nonuniformEXT"]),
    (5309, "StorageImageArrayNonUniformIndexing", &["nonuniformEXT"]),
    (5345, "VulkanMemoryModel", &["gl_ScopeDevice", "gl_ScopeQueueFamily"]),
    (5363, "FragmentShaderSampleInterlockEXT", &["sample_interlock_ordered", "sample_interlock_unordered"]),
    (5378, "FragmentShaderPixelInterlockEXT", &["pixel_interlock_ordered", "pixel_interlock_unordered"]),
    (5379, "DemoteToHelperInvocation", &["demote", "helperInvocationEXT"]),
    (6033, "AtomicFloat32AddEXT", &["atomicAdd", "imageAtomicAdd"]),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_is_known_once_and_none_is_both() {
        assert!(KNOWN.windows(2).all(|pair| pair[0].0 < pair[1].0), "ordered by number");
        assert!(KNOWN.iter().all(|(number, ..)| !AVAILABLE.contains(number)));
        assert!(missing(AVAILABLE).is_empty());
        assert_eq!(missing(&[1, 9999]), [Missing { name: "9999".to_owned(), glsl: &[] }]);
    }
}
