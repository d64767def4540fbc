# Explicit names, no glob: what is not listed is not built.
target_sources(duoptic PRIVATE ${PROJECT_SOURCE_DIR}/src/trackers/clicks.cpp ${PROJECT_SOURCE_DIR}/src/trackers/raw_left.cpp ${PROJECT_SOURCE_DIR}/src/trackers/selection.cpp)
set(dir ${PROJECT_SOURCE_DIR}/src/trackers/arm)
target_sources(duoptic PRIVATE
  ${dir}/arm.cpp ${dir}/arm_candidates.cpp ${dir}/arm_learn.cpp ${dir}/arm_start.cpp ${dir}/arm_tracker.cpp ${dir}/background.cpp
  ${dir}/body_map.cpp ${dir}/bones.cpp ${dir}/color_table.cpp ${dir}/fit_torso.cpp ${dir}/gray_levels.cpp ${dir}/grid.cpp
  ${dir}/hand.cpp ${dir}/patches.cpp ${dir}/regions.cpp ${dir}/silhouette.cpp ${dir}/torso.cpp)
duoptic_test(trackers/arm_parts ${dir}/arm_parts_test.cpp)
duoptic_test(trackers/arm_tracker ${dir}/arm_tracker_test.cpp)
duoptic_test(trackers/arm_clips ${dir}/arm_clips_test.cpp SLOW)
set(dir ${PROJECT_SOURCE_DIR}/src/trackers/body)
target_sources(duoptic PRIVATE
  ${dir}/behind_back.cpp ${dir}/body.cpp ${dir}/body_learn.cpp ${dir}/body_tracker.cpp ${dir}/candidates.cpp ${dir}/choose.cpp ${dir}/filled_margin.cpp ${dir}/fingers.cpp ${dir}/fit.cpp ${dir}/hidden_by.cpp ${dir}/imagined.cpp ${dir}/lengths.cpp ${dir}/lift.cpp ${dir}/limb_samples.cpp ${dir}/newcomers.cpp ${dir}/points.cpp
  ${dir}/seen_trunk.cpp ${dir}/sides.cpp ${dir}/surface_map.cpp ${dir}/trial.cpp ${dir}/uncover.cpp ${dir}/unlike.cpp ${dir}/upright.cpp)
duoptic_test(trackers/body_parts ${dir}/body_parts_test.cpp ${dir}/body_sides_test.cpp ${dir}/body_turned_test.cpp ${dir}/choose_test.cpp ${dir}/filled_margin_test.cpp ${dir}/fingers_test.cpp ${dir}/hidden_by_test.cpp ${dir}/uncover_test.cpp ${dir}/upright_test.cpp)
duoptic_test(trackers/body_tracker ${dir}/body_tracker_test.cpp ${dir}/body_newcomers_test.cpp ${dir}/body_nobody_test.cpp ${dir}/body_times_test.cpp ${dir}/body_scenes_test.cpp)
duoptic_test(trackers/body_clips ${dir}/body_clips_test.cpp SLOW)
set(dir ${PROJECT_SOURCE_DIR}/src/trackers/thesis)
target_sources(duoptic PRIVATE
  ${dir}/blob.cpp ${dir}/device_observer.cpp ${dir}/map_observer.cpp ${dir}/place_joints_ref.cpp ${dir}/points.cpp
  ${dir}/thesis_tracker.cpp)
if(DUO_VULKAN)
  duoptic_shader(${dir}/place_joints.comp)
  target_sources(duoptic PRIVATE ${dir}/device_observer_vk.cpp ${dir}/observe_joints_vk.cpp ${dir}/place_joints_vk.cpp)
endif()
duoptic_test(trackers/place_joints ${dir}/place_joints_test.cpp)
duoptic_test(trackers/thesis_tracker ${dir}/thesis_tracker_test.cpp)
duoptic_vulkan_test(trackers/kernels EVERY_SIZE ASSISTED SLOW ${dir}/place_joints_vk_test.cpp ${dir}/observe_joints_vk_test.cpp)
duoptic_vulkan_test(trackers/device ALONE VulkanTracking.LeavesTheCpuFree ${dir}/device_observer_vk_test.cpp)
