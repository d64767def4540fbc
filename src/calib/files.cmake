# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/calib)
target_sources(duoptic PRIVATE ${dir}/rectification.cpp ${dir}/rig.cpp ${dir}/rig_check.cpp ${dir}/rig_json.cpp
  ${dir}/rig_opencv.cpp)
duoptic_test(calib/clips ${dir}/clips_test.cpp)
duoptic_test(calib/rectification ${dir}/rectification_test.cpp)
duoptic_test(calib/rig ${dir}/rig_test.cpp)
