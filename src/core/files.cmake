# Explicit names, no glob: what is not listed is not built.
pkg_check_modules(TURBOJPEG REQUIRED IMPORTED_TARGET libturbojpeg)
target_link_libraries(duoptic PRIVATE PkgConfig::TURBOJPEG)
target_sources(duoptic PRIVATE ${PROJECT_SOURCE_DIR}/src/core/cache_file.cpp ${PROJECT_SOURCE_DIR}/src/core/coded_picture.cpp ${PROJECT_SOURCE_DIR}/src/core/file.cpp ${PROJECT_SOURCE_DIR}/src/core/lens.cpp
  ${PROJECT_SOURCE_DIR}/src/core/libav_file.cpp
  ${PROJECT_SOURCE_DIR}/src/core/pool.cpp ${PROJECT_SOURCE_DIR}/src/core/spelling.cpp ${PROJECT_SOURCE_DIR}/src/core/version.cpp
  ${PROJECT_SOURCE_DIR}/src/core/worker.cpp)
duoptic_test(core/statistics ${PROJECT_SOURCE_DIR}/src/core/statistics_test.cpp)
duoptic_test(core/pool ${PROJECT_SOURCE_DIR}/src/core/pool_test.cpp)
duoptic_test(core/file ${PROJECT_SOURCE_DIR}/src/core/file_test.cpp)
duoptic_test(core/worker ${PROJECT_SOURCE_DIR}/src/core/worker_test.cpp)
duoptic_test(core/object_pool ${PROJECT_SOURCE_DIR}/src/core/object_pool_test.cpp)
