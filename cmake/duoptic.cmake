# duoptic_stage(NAME [VULKAN [SHADERS more...]]): adds src/stages/NAME to the library and its test; with VULKAN also NAME.comp and
# the shaders named, NAME_vk.cpp, and NAME_vk_test.cpp to the one program that holds all kernels against their references.
# duoptic_test(GROUP/NAME SOURCES... [SLOW] [ALONE TESTS]): one ctest entry, which runs the tests of these files; the files of a group are one
# program. Of a release build TESTS (a pattern of GoogleTest's) are an entry of their own, beside which nothing runs: they measure time.

# Warnings are errors in our own builds; -ffp-contract=off because a fused multiply-add would round differently from engine to engine.
add_library(duoptic_flags INTERFACE)
target_compile_options(duoptic_flags INTERFACE -Wall -Wextra $<$<BOOL:${DUO_WERROR}>:-Werror> -ffp-contract=off)
# g++ 12 lacks what Highway's newest baseline asks for; with EMU128 allowed the baseline is tested like every other target.
# SSSE3 and AVX-512 without its later parts (byte counts and permutes) are left out: the few processors that have them lose little to
# SSE2 and AVX2, and each target has its share of the compile time.
# Highway 1.0.3 allows AVX-VNNI beside the newest AVX-512, which Ice Lake and Zen 4 lack. g++ makes no use of it, Clang does: there AVX2 is the most.
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  set(unsafe_targets "|HWY_AVX3_DL")
endif()
set(DUO_DISABLED_TARGETS "HWY_SSSE3|HWY_AVX3${unsafe_targets}" CACHE STRING "Instruction sets not to compile for, as Highway's HWY_ names joined by |")
target_compile_definitions(duoptic_flags INTERFACE HWY_BROKEN_EMU128=0 HWY_WANT_AVX3_DL "HWY_DISABLED_TARGETS=(${DUO_DISABLED_TARGETS})")

# Kernels are the same for every compiler and its options: another build folder's can be taken.
set(DUO_SPIRV "${PROJECT_BINARY_DIR}/spirv" CACHE PATH "Folder of the compiled kernels; one that is not this build's must be complete")

# SPIR-V as numbers to include.
function(duoptic_shader source)
  get_filename_component(name ${source} NAME)
  set(out ${DUO_SPIRV}/${name}.inc)
  if(NOT DUO_SPIRV STREQUAL "${PROJECT_BINARY_DIR}/spirv")
    return()
  endif()
  add_custom_command(OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${DUO_SPIRV}
    COMMAND ${DUO_GLSLC} -O --target-env=vulkan1.3 -I ${PROJECT_SOURCE_DIR}/src -mfmt=num -MD -MF ${out}.d -o ${out} ${source}
    DEPENDS ${source} DEPFILE ${out}.d COMMENT "SPIR-V ${name}" VERBATIM)
  target_sources(duoptic PRIVATE ${out})
endfunction()

if(DUO_TESTS)
  # The headers that every test reads, compiled once.
  add_library(duoptic_test_main OBJECT ${PROJECT_SOURCE_DIR}/tests/main.cpp ${PROJECT_SOURCE_DIR}/tests/allocations.cpp)
  target_link_libraries(duoptic_test_main PUBLIC duoptic duoptic_flags GTest::gtest PkgConfig::HWY)
  target_include_directories(duoptic_test_main PUBLIC ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/src)
  # Tests run once, and most of their compile time is the optimiser's; what they test is in the library. -Og takes two thirds of -O1's time.
  target_compile_options(duoptic_test_main PUBLIC $<IF:$<CONFIG:Release>,-Og,-O0>)
  target_precompile_headers(duoptic_test_main PRIVATE ${PROJECT_SOURCE_DIR}/tests/agree.h)
endif()

# In a unity build two dozen test files compile as one: what they include is most of their compile time.
function(duoptic_test_program target)
  if(NOT TARGET ${target})
    add_executable(${target})
    target_link_libraries(${target} PRIVATE duoptic_test_main)
    target_precompile_headers(${target} REUSE_FROM duoptic_test_main)
    set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE 24)
  endif()
endfunction()

# duoptic_test_alone(ENTRY TESTS COMMAND...): adds the entry ENTRY_alone, and gives in `others` what the command of ENTRY needs to leave TESTS out.
function(duoptic_test_alone name tests)
  set(others "" PARENT_SCOPE)
  if(NOT tests STREQUAL "" AND CMAKE_BUILD_TYPE STREQUAL "Release")
    set(others --gtest_filter=-${tests} PARENT_SCOPE)
    add_test(NAME ${name}_alone COMMAND ${ARGN} --gtest_filter=${tests} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    set_tests_properties(${name}_alone PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 600 RUN_SERIAL TRUE)
  endif()
endfunction()

function(duoptic_test name)
  cmake_parse_arguments(ARG "SLOW" "ALONE" "" ${ARGN})
  if(NOT DUO_TESTS OR (ARG_SLOW AND NOT DUO_SLOW_TESTS))
    return()
  endif()
  string(REGEX REPLACE "/.*" "_test" target ${name})
  duoptic_test_program(${target})
  target_sources(${target} PRIVATE ${ARG_UNPARSED_ARGUMENTS})
  duoptic_test_alone(${name} "${ARG_ALONE}" ${target} ${ARG_UNPARSED_ARGUMENTS})
  # ../shared/data is the default data.
  add_test(NAME ${name} COMMAND ${target} ${ARG_UNPARSED_ARGUMENTS} ${others} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 600)
  if(ARG_SLOW)
    set_tests_properties(${name} PROPERTIES COST 10)  # begins early, so that the last test to run is a short one
  endif()
endfunction()

# duoptic_vulkan_test(NAME [SOURCES...] [EVERY_SIZE] [ASSISTED] [SLOW] [ALONE TESTS]): one program, run at subgroups of 8, with EVERY_SIZE also of 4 and 16, what
# the software driver can take; with ASSISTED once more with every access of the kernels checked. Sanitizers do not see inside kernels: once.
function(duoptic_vulkan_test name)
  cmake_parse_arguments(ARG "EVERY_SIZE;ASSISTED;SLOW" "ALONE" "" ${ARGN})
  if(NOT DUO_TESTS OR NOT DUO_VULKAN OR (ARG_SLOW AND NOT DUO_SLOW_TESTS))
    return()
  endif()
  string(REPLACE "/" "_" target ${name}_test)
  duoptic_test_program(${target})
  target_sources(${target} PRIVATE ${ARG_UNPARSED_ARGUMENTS})
  target_link_libraries(${target} PRIVATE Vulkan::Headers)
  set(variants :LP_NATIVE_VECTOR_WIDTH=256)
  if(DUO_SLOW_TESTS AND ARG_EVERY_SIZE)
    list(APPEND variants _128:LP_NATIVE_VECTOR_WIDTH=128 _512:LP_NATIVE_VECTOR_WIDTH=512)
  endif()
  if(DUO_SLOW_TESTS AND ARG_ASSISTED)
    list(APPEND variants _assisted:DUOPTIC_GPU_ASSISTED=1)
  endif()
  duoptic_test_alone(${name} "${ARG_ALONE}" ${target})
  foreach(variant ${variants})
    string(REGEX REPLACE ":.*" "" suffix ${variant})
    string(REGEX REPLACE "^[^:]*:" "" environment ${variant})
    add_test(NAME ${name}${suffix} COMMAND ${target} ${others} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    set_tests_properties(${name}${suffix} PROPERTIES ENVIRONMENT ${environment} SKIP_RETURN_CODE 77 TIMEOUT 600)
  endforeach()
endfunction()

function(duoptic_stage name)
  cmake_parse_arguments(ARG "VULKAN;PLAIN" "" "SHADERS" ${ARGN})
  set(dir ${PROJECT_SOURCE_DIR}/src/stages/${name})
  target_sources(duoptic PRIVATE ${dir}/${name}_ref.cpp)
  if(NOT ARG_PLAIN)
    target_sources(duoptic PRIVATE ${dir}/${name}_simd.cpp)
  endif()
  if(ARG_VULKAN AND DUO_VULKAN)
    foreach(shader ${name} ${ARG_SHADERS})
      duoptic_shader(${dir}/${shader}.comp)
    endforeach()
    target_sources(duoptic PRIVATE ${dir}/${name}_vk.cpp)
    if(TARGET stages_vk_test)
      target_sources(stages_vk_test PRIVATE ${dir}/${name}_vk_test.cpp)
    endif()
  endif()
  duoptic_test(stages/${name} ${dir}/${name}_test.cpp)
endfunction()
