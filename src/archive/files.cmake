# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/archive)
target_sources(duoptic PRIVATE ${dir}/batch.cpp ${dir}/collect.cpp ${dir}/find_recordings.cpp ${dir}/layout.cpp ${dir}/process.cpp
  ${dir}/run_here.cpp ${dir}/run_on_slurm.cpp ${dir}/sha256.cpp ${dir}/summarize.cpp ${dir}/work.cpp)
duoptic_test(archive/archive ${dir}/archive_test.cpp)
if(DUO_TESTS)
  target_link_libraries(archive_test PRIVATE nlohmann_json::nlohmann_json)
endif()
