# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/evaluation)
target_sources(duoptic PRIVATE ${dir}/clip_truth.cpp ${dir}/depth_quality.cpp ${dir}/light_code.cpp ${dir}/light_decoder.cpp ${dir}/light_files.cpp ${dir}/light_folders.cpp ${dir}/light_patterns.cpp ${dir}/light_planes.cpp ${dir}/peers.cpp ${dir}/perturb.cpp ${dir}/record_light.cpp ${dir}/region_quality.cpp ${dir}/rendered_accuracy.cpp ${dir}/scene.cpp ${dir}/scene_contest.cpp
  ${dir}/score_clip.cpp ${dir}/score_disparity.cpp ${dir}/score_joints.cpp ${dir}/write_scene.cpp)
duoptic_test(evaluation/depth_quality ${dir}/depth_quality_test.cpp)
duoptic_test(evaluation/scores ${dir}/score_disparity_test.cpp ${dir}/score_joints_test.cpp)
duoptic_test(evaluation/structured_light ${dir}/light_code_test.cpp ${dir}/light_room_test.cpp ${dir}/record_light_test.cpp)
