# Explicit names, no glob: what is not listed is not built.
# devices.cpp also answers for a build without Vulkan.
target_sources(duoptic PRIVATE ${PROJECT_SOURCE_DIR}/src/vulkan/devices.cpp)
if(DUO_VULKAN)
  foreach(file instance device choose memory pipeline_cache buffer kernel recorder timer speed)
    target_sources(duoptic PRIVATE ${PROJECT_SOURCE_DIR}/src/vulkan/${file}.cpp)
  endforeach()
  # Headers only: the loader is opened at run time.
  target_link_libraries(duoptic PRIVATE Vulkan::Headers ${CMAKE_DL_LIBS})
endif()

duoptic_vulkan_test(vulkan ${PROJECT_SOURCE_DIR}/tests/vulkan/vulkan_test.cpp ASSISTED)
