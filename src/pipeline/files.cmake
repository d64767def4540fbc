# Explicit names, no glob: what is not listed is not built.
target_sources(duoptic PRIVATE ${PROJECT_SOURCE_DIR}/src/pipeline/registry.cpp ${PROJECT_SOURCE_DIR}/src/pipeline/write_clip.cpp
  ${PROJECT_SOURCE_DIR}/src/pipeline/export_recording.cpp ${PROJECT_SOURCE_DIR}/src/pipeline/flat_picture.cpp
  ${PROJECT_SOURCE_DIR}/src/pipeline/focus_line.cpp ${PROJECT_SOURCE_DIR}/src/pipeline/found_watch.cpp
  ${PROJECT_SOURCE_DIR}/src/pipeline/frame_stream.cpp ${PROJECT_SOURCE_DIR}/src/pipeline/pipeline.cpp
  ${PROJECT_SOURCE_DIR}/src/pipeline/black_bars.cpp ${PROJECT_SOURCE_DIR}/src/pipeline/offset_watch.cpp
  ${PROJECT_SOURCE_DIR}/src/pipeline/pass_over.cpp ${PROJECT_SOURCE_DIR}/src/pipeline/player.cpp ${PROJECT_SOURCE_DIR}/src/pipeline/picture_watch.cpp
  ${PROJECT_SOURCE_DIR}/src/pipeline/repeat_watch.cpp ${PROJECT_SOURCE_DIR}/src/pipeline/rig_watch.cpp
  ${PROJECT_SOURCE_DIR}/src/pipeline/sink_kinds.cpp ${PROJECT_SOURCE_DIR}/src/pipeline/skew_watch.cpp
  ${PROJECT_SOURCE_DIR}/src/pipeline/tap.cpp)
duoptic_test(pipeline/pipeline ${PROJECT_SOURCE_DIR}/src/pipeline/pipeline_test.cpp)
duoptic_test(pipeline/pipeline_focus ${PROJECT_SOURCE_DIR}/src/pipeline/pipeline_focus_test.cpp)
duoptic_test(pipeline/flat_picture ${PROJECT_SOURCE_DIR}/src/pipeline/flat_picture_test.cpp)
duoptic_test(pipeline/cpu_budget ${PROJECT_SOURCE_DIR}/src/pipeline/cpu_budget_test.cpp)
duoptic_test(pipeline/focus_line ${PROJECT_SOURCE_DIR}/src/pipeline/focus_line_test.cpp)
duoptic_test(pipeline/found_watch ${PROJECT_SOURCE_DIR}/src/pipeline/found_watch_test.cpp)
duoptic_test(pipeline/black_bars ${PROJECT_SOURCE_DIR}/src/pipeline/black_bars_test.cpp)
duoptic_test(pipeline/offset_watch ${PROJECT_SOURCE_DIR}/src/pipeline/offset_watch_test.cpp)
duoptic_test(pipeline/picture_watch ${PROJECT_SOURCE_DIR}/src/pipeline/picture_watch_test.cpp)
duoptic_test(pipeline/repeat_watch ${PROJECT_SOURCE_DIR}/src/pipeline/repeat_watch_test.cpp)
duoptic_test(pipeline/player ${PROJECT_SOURCE_DIR}/src/pipeline/player_test.cpp)
duoptic_test(pipeline/rig_watch ${PROJECT_SOURCE_DIR}/src/pipeline/rig_watch_test.cpp)
duoptic_test(pipeline/sink_kinds ${PROJECT_SOURCE_DIR}/src/pipeline/sink_kinds_test.cpp)
duoptic_test(pipeline/skew_watch ${PROJECT_SOURCE_DIR}/src/pipeline/skew_watch_test.cpp)
duoptic_test(pipeline/tap ${PROJECT_SOURCE_DIR}/src/pipeline/tap_test.cpp)
duoptic_test(pipeline/write_clip ${PROJECT_SOURCE_DIR}/src/pipeline/write_clip_test.cpp)
if(DUO_TESTS)
  target_link_libraries(pipeline_test PRIVATE nlohmann_json::nlohmann_json)
endif()
