# Explicit names, no glob: what is not listed is not built.
set(dir ${PROJECT_SOURCE_DIR}/src/matchers/pyramid)
target_sources(duoptic PRIVATE ${dir}/pyramid.cpp ${dir}/pyramid_params.cpp ${dir}/pyramid_ref.cpp ${dir}/pyramid_simd.cpp)
duoptic_test(matchers/pyramid ${dir}/pyramid_test.cpp)
if(DUO_VULKAN)
  target_sources(duoptic PRIVATE ${dir}/pyramid_vk.cpp)
  duoptic_vulkan_test(matchers/vk ${dir}/pyramid_vk_test.cpp)  # of every matcher
endif()
set(dir ${PROJECT_SOURCE_DIR}/src/matchers/sgm)
target_sources(duoptic PRIVATE ${dir}/sgm.cpp ${dir}/sgm_params.cpp ${dir}/sgm_ref.cpp ${dir}/sgm_simd.cpp)
duoptic_test(matchers/sgm ${dir}/sgm_test.cpp)
