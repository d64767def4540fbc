# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/evaluation)
target_sources(duoptic PRIVATE ${dir}/clip_truth.cpp ${dir}/depth_quality.cpp ${dir}/peers.cpp ${dir}/perturb.cpp ${dir}/rendered_accuracy.cpp ${dir}/scene.cpp
  ${dir}/score_clip.cpp ${dir}/score_disparity.cpp ${dir}/score_joints.cpp)
duoptic_test(evaluation/depth_quality ${dir}/depth_quality_test.cpp)
duoptic_test(evaluation/scores ${dir}/score_disparity_test.cpp ${dir}/score_joints_test.cpp)
