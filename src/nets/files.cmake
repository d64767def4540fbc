# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/nets)
target_sources(duoptic PRIVATE ${dir}/net_file.cpp ${dir}/net_check.cpp
  ${dir}/memory_plan.cpp ${dir}/net_run.cpp)
duoptic_test(nets/net_file ${dir}/net_file_test.cpp)
duoptic_test(nets/models ${dir}/models_test.cpp)
find_library(DUO_XNNPACK XNNPACK)  # Debian's libxnnpack-dev; a peer for tests alone
if(DUO_XNNPACK)
  duoptic_test(nets/xnnpack ${dir}/xnnpack_test.cpp SLOW)
  if(TARGET nets_test AND DUO_SLOW_TESTS)
    target_link_libraries(nets_test PRIVATE ${DUO_XNNPACK})
  endif()
endif()
