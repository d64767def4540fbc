# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/sinks)
target_sources(duoptic PRIVATE
  ${dir}/clip/avi.cpp
  ${dir}/draw_arm_region.cpp
  ${dir}/draw_cloud.cpp
  ${dir}/draw_disparity.cpp
  ${dir}/draw_hue.cpp
  ${dir}/draw_panels.cpp
  ${dir}/json_lines.cpp
  ${dir}/panel_video.cpp
  ${dir}/pfm.cpp
  ${dir}/ply.cpp
  ${dir}/png.cpp
  ${dir}/video_writer.cpp)
duoptic_test(sinks/files ${dir}/files_test.cpp)
duoptic_test(sinks/recording ${dir}/recording_test.cpp)
if(DUO_TESTS)
  target_link_libraries(sinks_files_test PRIVATE opencv::core opencv::imgcodecs)
endif()
