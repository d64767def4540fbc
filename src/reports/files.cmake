# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/reports)
target_sources(duoptic PRIVATE ${dir}/batch_status.cpp ${dir}/calibration_report.cpp ${dir}/clip_scores.cpp ${dir}/depth_quality.cpp
  ${dir}/light_truth.cpp ${dir}/machine_reports.cpp ${dir}/recording_report.cpp ${dir}/rig_reports.cpp ${dir}/scene_scores.cpp
  ${dir}/seen_people.cpp)
duoptic_test(reports/reports ${dir}/reports_test.cpp)
if(DUO_TESTS)
  target_link_libraries(reports_test PRIVATE nlohmann_json::nlohmann_json)
endif()
