# Explicit names, no glob: what is not listed is not built.
# Pictures and videos through libav itself: it tells whole pictures from partly decoded ones, and prints nothing by itself.
pkg_check_modules(LIBAV REQUIRED IMPORTED_TARGET libavformat libavcodec libswscale libavutil)
pkg_check_modules(CURL REQUIRED IMPORTED_TARGET libcurl)
target_link_libraries(duoptic PRIVATE PkgConfig::LIBAV PkgConfig::CURL)
target_sources(duoptic PRIVATE
  ${PROJECT_SOURCE_DIR}/src/sources/board_pictures.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/open_input.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/open_source.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/arrival_clock.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/container_end.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/packet_check.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/wide_values.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/gst_process.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/http_bytes.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/in_real_time.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/libav.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/one_source.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/orientation.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/pairing.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/pairs.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/picture_bytes.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/pictures.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/recording.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/rising_times.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/source_choice.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/stereo_layout.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/stream.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/stream_input.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/two_files.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/two_views.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/video.cpp)
duoptic_test(sources/files ${PROJECT_SOURCE_DIR}/src/sources/files_test.cpp ${PROJECT_SOURCE_DIR}/src/sources/file_pairs_test.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/picture_bytes_test.cpp ${PROJECT_SOURCE_DIR}/src/sources/board_pictures_test.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/open_input_test.cpp ${PROJECT_SOURCE_DIR}/src/sources/source_choice_test.cpp ${PROJECT_SOURCE_DIR}/src/sources/rising_times_test.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/two_views_test.cpp)
foreach(file camera camera_search clock_model controls decode device modes system_calls)
  target_sources(duoptic PRIVATE ${PROJECT_SOURCE_DIR}/src/sources/camera/${file}.cpp)
endforeach()
target_sources(duoptic PRIVATE ${PROJECT_SOURCE_DIR}/src/sources/live/live_pairs.cpp)
duoptic_test(sources/libav ${PROJECT_SOURCE_DIR}/src/sources/libav_test.cpp)
duoptic_test(sources/pass_to ${PROJECT_SOURCE_DIR}/src/sources/pass_to_test.cpp)
duoptic_test(sources/live ${PROJECT_SOURCE_DIR}/src/sources/live/live_test.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/camera/camera_test.cpp ${PROJECT_SOURCE_DIR}/src/sources/stream_test.cpp)
if(DUO_TESTS)
  set_tests_properties(sources/live PROPERTIES RUN_SERIAL TRUE)  # it measures when pictures come
endif()
include(${CMAKE_CURRENT_LIST_DIR}/synthetic/files.cmake)
