# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/engines)
target_sources(duoptic PRIVATE ${dir}/filling.cpp ${dir}/focused.cpp ${dir}/keep_windows.cpp ${dir}/prepared.cpp ${dir}/ref_engine.cpp ${dir}/simd_engine.cpp
  ${dir}/simd_frames.cpp ${dir}/vulkan_choice.cpp)
target_compile_definitions(duoptic PRIVATE DUO_VULKAN=$<BOOL:${DUO_VULKAN}>)
if(DUO_VULKAN)
  target_sources(duoptic PRIVATE ${dir}/vulkan_engine.cpp ${dir}/vulkan_frames.cpp)
endif()
