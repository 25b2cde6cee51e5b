// Stands in for what shaderc links and Specula never runs: it compiles GLSL, at optimization level zero.

// shaderc calls functions of HLSL, whatever glslang has.
#define ENABLE_HLSL
#include "glslang/Public/ShaderLang.h"
#include "spirv-tools/optimizer.hpp"

void glslang::TShader::setHlslIoMapping(bool) {}

namespace spvtools {

struct Optimizer::Impl {};
struct Optimizer::PassToken::Impl {};

Optimizer::PassToken::PassToken(std::unique_ptr<Impl>) {}
Optimizer::PassToken::~PassToken() = default;
Optimizer::PassToken CreateStripDebugInfoPass() { return std::unique_ptr<Optimizer::PassToken::Impl>(); }
Optimizer::PassToken CreateCompactIdsPass() { return std::unique_ptr<Optimizer::PassToken::Impl>(); }

Optimizer::Optimizer(spv_target_env) {}
Optimizer::~Optimizer() = default;
void Optimizer::SetMessageConsumer(MessageConsumer) {}
Optimizer& Optimizer::RegisterPass(PassToken&&) { return *this; }
Optimizer& Optimizer::RegisterPerformancePasses() { return *this; }
Optimizer& Optimizer::RegisterSizePasses() { return *this; }
Optimizer& Optimizer::RegisterLegalizationPasses() { return *this; }

// Fails, so that no caller takes an unchanged module for an optimized one.
bool Optimizer::Run(const uint32_t*, size_t, std::vector<uint32_t>*, const spv_optimizer_options) const { return false; }

}  // namespace spvtools
