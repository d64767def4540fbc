# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/detectors)
target_sources(duoptic PRIVATE ${dir}/find_people.cpp ${dir}/fixed.cpp ${dir}/hand_region.cpp ${dir}/net_detector.cpp
  ${dir}/people_finder.cpp ${dir}/place.cpp ${dir}/point_names.cpp ${dir}/see_points.cpp ${dir}/truth_detector.cpp)
target_link_libraries(duoptic PRIVATE ${CMAKE_DL_LIBS})
# Installed, the networks are found from where the library is, so that a moved installation finds them, too.
file(RELATIVE_PATH models_from_library /prefix/${CMAKE_INSTALL_LIBDIR} /prefix/${DUO_MODELS_FOLDER})
set_source_files_properties(${dir}/net_detector.cpp PROPERTIES COMPILE_DEFINITIONS
  "DUO_MODELS=\"${PROJECT_SOURCE_DIR}/models\";DUO_MODELS_FROM_LIBRARY=\"${models_from_library}\"")
duoptic_test(detectors/detectors ${dir}/detectors_test.cpp)
if(DUO_VULKAN)
  duoptic_vulkan_test(detectors/vk ${dir}/detectors_vk_test.cpp)
endif()
duoptic_test(detectors/persons_lab ${dir}/persons_lab_test.cpp SLOW)
duoptic_test(detectors/accuracy ${dir}/accuracy_test.cpp SLOW)
duoptic_test(detectors/closed_loop ${dir}/closed_loop_test.cpp SLOW)
if(TARGET detectors_test)
  target_link_libraries(detectors_test PRIVATE nlohmann_json::nlohmann_json)
  if(with_xnnpack AND DUO_SLOW_TESTS)
    target_compile_definitions(detectors_test PRIVATE DUO_XNNPACK)
  endif()
endif()
