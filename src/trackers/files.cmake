# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/trackers/arm)
target_sources(duoptic PRIVATE
  ${dir}/arm.cpp ${dir}/arm_candidates.cpp ${dir}/arm_learn.cpp ${dir}/arm_start.cpp ${dir}/arm_tracker.cpp ${dir}/background.cpp
  ${dir}/body_map.cpp ${dir}/bones.cpp ${dir}/color_table.cpp ${dir}/fit_torso.cpp ${dir}/gray_levels.cpp ${dir}/grid.cpp
  ${dir}/hand.cpp ${dir}/patches.cpp ${dir}/raw_left.cpp ${dir}/regions.cpp ${dir}/silhouette.cpp ${dir}/thesis_blob.cpp
  ${dir}/thesis_observe.cpp ${dir}/thesis_points.cpp ${dir}/thesis_tracker.cpp ${dir}/torso.cpp)
if(DUO_VULKAN)
  target_sources(duoptic PRIVATE ${dir}/thesis_vk.cpp)
endif()
duoptic_test(trackers/arm_parts ${dir}/arm_parts_test.cpp)
duoptic_test(trackers/arm_tracker ${dir}/arm_tracker_test.cpp)
duoptic_test(trackers/arm_clips ${dir}/arm_clips_test.cpp SLOW)
duoptic_test(trackers/thesis_tracker ${dir}/thesis_tracker_test.cpp)
