# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/sinks)
# OSC messages, for other programs.
pkg_check_modules(LIBLO REQUIRED IMPORTED_TARGET liblo)
target_link_libraries(duoptic PRIVATE PkgConfig::LIBLO)
target_sources(duoptic PRIVATE
  ${dir}/axes.cpp
  ${dir}/bvh.cpp
  ${dir}/clip/avi.cpp
  ${dir}/coded_view.cpp
  ${dir}/csv.cpp
  ${dir}/depth_video.cpp
  ${dir}/far_watch.cpp
  ${dir}/frame_files.cpp
  ${dir}/frame_folder.cpp
  ${dir}/gltf.cpp
  ${dir}/in_background.cpp
  ${dir}/json_lines.cpp
  ${dir}/mcap/mcap_file.cpp
  ${dir}/mcap/mcap_sink.cpp
  ${dir}/motion_tracks.cpp
  ${dir}/osc.cpp
  ${dir}/osc_target.cpp
  ${dir}/output_set.cpp
  ${dir}/panel_video.cpp
  ${dir}/pfm.cpp
  ${dir}/ply.cpp
  ${dir}/png.cpp
  ${dir}/recorder.cpp
  ${dir}/settled_bones.cpp
  ${dir}/trc.cpp
  ${dir}/video_writer.cpp
  ${dir}/vmc.cpp)
duoptic_test(sinks/files ${dir}/files_test.cpp)
duoptic_test(sinks/frame_files ${dir}/frame_files_test.cpp)
duoptic_test(sinks/tracked_frames ${dir}/tracked_frames_test.cpp ${dir}/settled_bones_test.cpp)
duoptic_test(sinks/other_programs ${dir}/motion_files_test.cpp ${dir}/osc_test.cpp ${dir}/mcap/mcap_test.cpp)
duoptic_test(sinks/recorder ${dir}/recorder_test.cpp ${dir}/recorder_names_test.cpp)
if(DUO_TESTS)
  target_link_libraries(sinks_test PRIVATE PkgConfig::LIBLO nlohmann_json::nlohmann_json opencv::core opencv::imgcodecs)
endif()
