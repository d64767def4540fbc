# Explicit names, no glob: what is not listed is not built.
target_sources(duoptic PRIVATE ${PROJECT_SOURCE_DIR}/src/pipeline/registry.cpp ${PROJECT_SOURCE_DIR}/src/pipeline/write_clip.cpp)
