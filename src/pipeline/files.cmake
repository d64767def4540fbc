# Explicit names, no glob: what is not listed is not built.
target_sources(duoptic PRIVATE ${PROJECT_SOURCE_DIR}/src/pipeline/registry.cpp ${PROJECT_SOURCE_DIR}/src/pipeline/write_clip.cpp
  ${PROJECT_SOURCE_DIR}/src/pipeline/export_recording.cpp)
duoptic_test(pipeline/write_clip ${PROJECT_SOURCE_DIR}/src/pipeline/write_clip_test.cpp)
if(DUO_TESTS)
  target_link_libraries(pipeline_test PRIVATE nlohmann_json::nlohmann_json)
endif()
