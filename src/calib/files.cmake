# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/calib)
target_sources(duoptic PRIVATE ${dir}/align_match.cpp ${dir}/judge_scene.cpp ${dir}/moved_points.cpp ${dir}/postures.cpp ${dir}/rig_fit.cpp ${dir}/lens_left_over.cpp ${dir}/normal_equations.cpp ${dir}/opencv_rectified.cpp ${dir}/rectification.cpp ${dir}/rig.cpp
  ${dir}/rig_check.cpp ${dir}/rig_doubts.cpp ${dir}/rig_files.cpp ${dir}/rig_health.cpp ${dir}/rig_json.cpp
  ${dir}/rig_kalibr.cpp ${dir}/rig_lines.cpp ${dir}/rig_opencv.cpp ${dir}/rig_ros.cpp ${dir}/rig_size.cpp
  ${dir}/rig_two_texts.cpp ${dir}/rig_yaml.cpp ${dir}/row_offsets.cpp ${dir}/scene_matches.cpp ${dir}/scene_patches.cpp
  ${dir}/scene_pose.cpp ${dir}/yaml_reader.cpp)
target_sources(duoptic PRIVATE ${dir}/board.cpp ${dir}/board_files.cpp ${dir}/board_page.cpp ${dir}/bundle.cpp
  ${dir}/calibrate.cpp ${dir}/calibration_guide.cpp ${dir}/calibration_report.cpp ${dir}/calibration_session.cpp ${dir}/describe.cpp ${dir}/doubt_calibration.cpp ${dir}/find_board.cpp
  ${dir}/find_markers.cpp ${dir}/judge_bundle.cpp ${dir}/picture_figures.cpp ${dir}/recognise_board.cpp ${dir}/rectify_pair.cpp ${dir}/refine_corners.cpp ${dir}/report_plots.cpp
  ${dir}/start_bundle.cpp)
duoptic_test(calib/align_match ${dir}/align_match_test.cpp)
duoptic_test(calib/board ${dir}/board_test.cpp)
duoptic_test(calib/board_sets ${dir}/board_sets_test.cpp SLOW)
duoptic_test(calib/calibrate ${dir}/calibrate_test.cpp SLOW)
duoptic_test(calib/calibration_guide ${dir}/calibration_guide_test.cpp)
duoptic_test(calib/calibration_session ${dir}/calibration_session_test.cpp)
duoptic_test(calib/clips ${dir}/clips_test.cpp)
duoptic_test(calib/recognise_board ${dir}/recognise_board_test.cpp)
duoptic_test(calib/rectification ${dir}/rectification_test.cpp)
duoptic_test(calib/rig ${dir}/rig_test.cpp)
duoptic_test(calib/rig_files ${dir}/rig_files_test.cpp)
duoptic_test(calib/rig_imports ${dir}/rig_imports_test.cpp)
duoptic_test(calib/rig_fit ${dir}/moved_points_test.cpp ${dir}/rig_fit_test.cpp ${dir}/rig_fitting_test.cpp)
duoptic_test(calib/scene_patches ${dir}/scene_patches_test.cpp)
duoptic_test(calib/rig_health ${dir}/rig_health_test.cpp)
duoptic_test(calib/row_offsets ${dir}/row_offsets_test.cpp)
duoptic_test(calib/scene_clips ${dir}/scene_clips_test.cpp SLOW)
if(DUO_TESTS)
  target_link_libraries(calib_test PRIVATE opencv::core)  # reads what we write for it
endif()
