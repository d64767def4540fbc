# Explicit names, no glob: what is not listed is not built.
# devices.cpp also answers for a build without Vulkan.
target_sources(duoptic PRIVATE ${PROJECT_SOURCE_DIR}/src/vulkan/devices.cpp)
target_compile_definitions(duoptic PRIVATE DUO_VULKAN=$<BOOL:${DUO_VULKAN}>)
if(DUO_VULKAN)
  foreach(file instance device buffer kernel recorder timer)
    target_sources(duoptic PRIVATE ${PROJECT_SOURCE_DIR}/src/vulkan/${file}.cpp)
  endforeach()
  # Headers only: the loader is opened at run time.
  target_link_libraries(duoptic PRIVATE Vulkan::Headers ${CMAKE_DL_LIBS})
endif()

# duoptic_vulkan_test(NAME SOURCE): one program, run at each subgroup size that the software driver can take (4, 8, 16).
function(duoptic_vulkan_test name source)
  if(NOT DUO_TESTS OR NOT DUO_VULKAN)
    return()
  endif()
  duoptic_test(${name} ${source})
  string(REPLACE "/" "_" target ${name}_test)
  target_link_libraries(${target} PRIVATE Vulkan::Headers)
  set_tests_properties(${name} PROPERTIES ENVIRONMENT LP_NATIVE_VECTOR_WIDTH=256)
  foreach(width 128 512)
    add_test(NAME ${name}_${width} COMMAND ${target})
    set_tests_properties(${name}_${width} PROPERTIES ENVIRONMENT LP_NATIVE_VECTOR_WIDTH=${width}
      SKIP_RETURN_CODE 77 TIMEOUT 600)
  endforeach()
endfunction()

duoptic_vulkan_test(vulkan ${PROJECT_SOURCE_DIR}/tests/vulkan/vulkan_test.cpp)
