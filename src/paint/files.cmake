# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/paint)
target_sources(duoptic PRIVATE
  ${dir}/draw_cloud.cpp
  ${dir}/draw_disparity.cpp
  ${dir}/draw_hue.cpp
  ${dir}/draw_panels.cpp
  ${dir}/draw_people.cpp
  ${dir}/draw_points.cpp
  ${dir}/draw_regions.cpp
  ${dir}/shapes.cpp
  ${dir}/side_by_side.cpp)
duoptic_test(paint/paint ${dir}/paint_test.cpp)
