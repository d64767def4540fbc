# The window of `duoptic view`: part of the tool, and the only code that sees GLFW, ImGui and OpenGL.
set(dir ${PROJECT_SOURCE_DIR}/apps/viewer)
target_sources(duoptic_tool PRIVATE
  ${dir}/calibration_page.cpp
  ${dir}/depth_panel.cpp
  ${dir}/panels.cpp
  ${dir}/pattern_screen.cpp
  ${dir}/sidebar.cpp
  ${dir}/start.cpp
  ${dir}/style.cpp
  ${dir}/texture.cpp
  ${dir}/view.cpp
  ${dir}/window.cpp)
target_include_directories(duoptic_tool PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(duoptic_tool PRIVATE PkgConfig::IMGUI PkgConfig::EPOXY glfw)
target_compile_definitions(duoptic_tool PRIVATE DUO_VIEWER)
