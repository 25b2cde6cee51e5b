# Builds only the part of shaderc that Specula links: a quarter of its C++. `.cargo/config.toml` names this file as CMake's toolchain
# file, the one way to give options to the build script of shaderc-sys. It changes nothing about the compiler.

# CMake reads a toolchain file again in each of its trial compilations.
get_property(is_trial GLOBAL PROPERTY IN_TRY_COMPILE)
get_property(is_read GLOBAL PROPERTY specula_is_read)
if(is_trial OR is_read)
  return()
endif()
set_property(GLOBAL PROPERTY specula_is_read TRUE)

# Specula compiles GLSL, and optimizes SPIR-V by itself.
foreach(option ENABLE_HLSL ENABLE_OPT GLSLANG_ENABLE_INSTALL)
  set(${option} OFF CACHE BOOL "")
endforeach()
foreach(option SKIP_SPIRV_TOOLS_INSTALL SHADERC_SKIP_INSTALL SHADERC_SKIP_EXAMPLES SHADERC_SKIP_EXECUTABLES SHADERC_SKIP_COPYRIGHT_CHECK)
  set(${option} ON CACHE BOOL "")
endforeach()
set(specula_folder ${CMAKE_CURRENT_LIST_DIR})

# Runs after all targets are declared.
function(specula_trim)
  # The library holds the objects of the targets that it needs, so they are built for it. All other targets are left out.
  foreach(folder spirv-tools spirv-tools/source spirv-tools/source/opt spirv-tools/source/reduce spirv-tools/source/link
                 spirv-tools/source/lint spirv-tools/source/diff glslang/glslang glslang/SPIRV shaderc/libshaderc shaderc/glslc)
    get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
    list(REMOVE_ITEM targets shaderc_combined)
    foreach(target ${targets})
      set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL TRUE)
    endforeach()
  endforeach()
  set_property(TARGET SPIRV-Tools-opt PROPERTY SOURCES ${specula_folder}/left_out.cpp)
  target_include_directories(SPIRV-Tools-opt PRIVATE ${CMAKE_SOURCE_DIR}/glslang)
  # Of SPIRV-Tools, tests alone call the validator. glslang keeps the optimization level of the build.
  if(NOT MSVC)
    target_compile_options(SPIRV-Tools-static PRIVATE -O1)
  endif()
  target_precompile_headers(SPIRV-Tools-static PRIVATE
    $<$<COMPILE_LANGUAGE:CXX>:${CMAKE_SOURCE_DIR}/spirv-tools/source/val/validate.h>
    $<$<COMPILE_LANGUAGE:CXX>:${CMAKE_SOURCE_DIR}/spirv-tools/source/val/validation_state.h>)
  install(TARGETS shaderc_combined DESTINATION lib)
endfunction()
cmake_language(DEFER DIRECTORY ${CMAKE_SOURCE_DIR} CALL specula_trim)
