# The window of `duoptic view`: part of the tool, and the only code that sees GLFW, ImGui and a swapchain.
set(dir ${PROJECT_SOURCE_DIR}/apps/viewer)
target_sources(duoptic_tool PRIVATE
  ${dir}/clicks.cpp
  ${dir}/cloud.cpp
  ${dir}/gpu.cpp
  ${dir}/panels.cpp
  ${dir}/player.cpp
  ${dir}/sidebar.cpp
  ${dir}/style.cpp
  ${dir}/swapchain.cpp
  ${dir}/textures.cpp
  ${dir}/view.cpp
  ${dir}/window.cpp)
target_include_directories(duoptic_tool PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${DUO_SPIRV}/..)
target_link_libraries(duoptic_tool PRIVATE PkgConfig::IMGUI glfw Vulkan::Vulkan)
target_compile_definitions(duoptic_tool PRIVATE DUO_VIEWER)
duoptic_shader(${dir}/picture.vert TARGET duoptic_tool VULKAN 1.0)
duoptic_shader(${dir}/picture.frag TARGET duoptic_tool VULKAN 1.0)
