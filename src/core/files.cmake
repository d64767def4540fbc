# Explicit names, no glob: what is not listed is not built.
target_sources(duoptic PRIVATE ${PROJECT_SOURCE_DIR}/src/core/file.cpp ${PROJECT_SOURCE_DIR}/src/core/lens.cpp
  ${PROJECT_SOURCE_DIR}/src/core/pool.cpp)
duoptic_test(core/pool ${PROJECT_SOURCE_DIR}/src/core/pool_test.cpp)
