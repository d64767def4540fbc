# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/detectors)
target_sources(duoptic PRIVATE ${dir}/find_people.cpp ${dir}/fixed.cpp ${dir}/hand_region.cpp ${dir}/net_detector.cpp
  ${dir}/people_finder.cpp ${dir}/place.cpp ${dir}/point_names.cpp ${dir}/see_points.cpp ${dir}/truth_detector.cpp)
set_source_files_properties(${dir}/net_detector.cpp PROPERTIES COMPILE_DEFINITIONS DUO_MODELS="${PROJECT_SOURCE_DIR}/models")
duoptic_test(detectors/detectors ${dir}/detectors_test.cpp)
duoptic_test(detectors/persons_lab ${dir}/persons_lab_test.cpp SLOW)
duoptic_test(detectors/accuracy ${dir}/accuracy_test.cpp SLOW)
if(TARGET detectors_test)
  target_link_libraries(detectors_test PRIVATE nlohmann_json::nlohmann_json)
endif()
