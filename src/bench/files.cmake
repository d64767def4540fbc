# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/bench)
target_sources(duoptic PRIVATE ${dir}/clip.cpp ${dir}/device.cpp ${dir}/frames.cpp ${dir}/networks.cpp)
duoptic_test(reports/bench ${dir}/bench_test.cpp)
