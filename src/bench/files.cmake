# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/bench)
target_sources(duoptic PRIVATE ${dir}/clip.cpp ${dir}/device.cpp ${dir}/frames.cpp ${dir}/networks.cpp)
duoptic_test(bench/bench ${dir}/bench_test.cpp)
if(DUO_TESTS)
  target_link_libraries(bench_test PRIVATE nlohmann_json::nlohmann_json)
endif()
