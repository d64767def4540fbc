# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/engines)
target_sources(duoptic PRIVATE ${dir}/prepared.cpp ${dir}/ref_engine.cpp ${dir}/simd_engine.cpp)
