# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/body)
target_sources(duoptic PRIVATE
  ${dir}/bone_turns.cpp
  ${dir}/person.cpp
  ${dir}/skeleton.cpp)
duoptic_test(body/body ${dir}/body_test.cpp)
