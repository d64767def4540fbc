#include "window.h"

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui/backends/imgui_impl_glfw.h>
#include <imgui/backends/imgui_impl_opengl3.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "duoptic/sink.h"

namespace duo::app::view {
namespace {

/// What GLFW complained of; it speaks through a call-back.
std::string& glfw_words() {
  static std::string words;
  return words;
}

Error no_window(std::string_view reason, std::string_view remedy) {
  std::string words = glfw_words();
  std::replace(words.begin(), words.end(), '\n', ' ');
  return {ErrorCode::kUnsupported,
          fmt::format("cannot open a window: {} ({}); {}", reason, words.empty() ? "GLFW gives no reason" : words, remedy)};
}

Error no_display() {
  const bool named = std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
  return no_window(named ? "the display does not answer" : "there is no display: DISPLAY is not set",
                   "without a display use duoptic track, or run under xvfb-run");
}

Error no_driver() {
  return no_window("there is no driver for OpenGL 3.0",
                   "install the graphics card's, or libgl1-mesa-dri, whose software driver runs anywhere");
}

/// The back buffer as it was drawn, top row first.
Image<Rgb8> drawn_pixels() {
  const ImDrawData& data = *ImGui::GetDrawData();
  Image<Rgb8> out({static_cast<int>(data.DisplaySize.x * data.FramebufferScale.x),
                   static_cast<int>(data.DisplaySize.y * data.FramebufferScale.y)});
  // OpenGL ES reads no RGB, and the bottom row comes first.
  std::vector<std::uint8_t> rgba(std::size_t{4} * out.width() * out.height());
  glReadPixels(0, 0, out.width(), out.height(), GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  const std::uint8_t* p = rgba.data();
  for (int y = out.height() - 1; y >= 0; --y)
    for (int x = 0; x < out.width(); ++x, p += 4) out.at(y, x) = {p[0], p[1], p[2]};
  return out;
}

}  // namespace

std::string free_name(const char* ending) {
  std::error_code ignored;
  for (int i = 1;; ++i)
    if (const std::string name = fmt::format("duoptic_view_{:03}{}", i, ending); !std::filesystem::exists(name, ignored))
      return name;
}

Result<std::unique_ptr<Window>> Window::open(const std::string& title, Size size) {
  std::unique_ptr<Window> out(new Window);
  DUO_TRY(out->create_window(title, size));
  DUO_TRY(out->create_imgui());
  return out;
}

Window::~Window() {
  if (renderer_) ImGui_ImplOpenGL3_Shutdown();
  if (platform_) ImGui_ImplGlfw_Shutdown();
  if (ImGui::GetCurrentContext() != nullptr) ImGui::DestroyContext();
  if (window_ != nullptr) glfwDestroyWindow(window_);
  if (glfw_) glfwTerminate();
}

void Window::wait(double seconds) { glfwWaitEventsTimeout(seconds); }
void Window::wake() { glfwPostEmptyEvent(); }
bool Window::closing() const { return glfwWindowShouldClose(window_) != GLFW_FALSE; }
std::string Window::device() const { return reinterpret_cast<const char*>(glGetString(GL_RENDERER)); }

std::vector<int> Window::keys() {
  std::vector<int> out = std::exchange(keys_, {});
  if (ImGui::GetIO().WantTextInput) out.clear();
  return out;
}

std::string Window::write_screenshot() {
  const auto picture = screenshot();
  if (!picture) return {};
  const std::string name = free_name(".png");
  const auto written = write_png(*picture, name);
  return written ? "written: " + name : written.error().what;
}

void Window::set_title(const std::string& title) {
  if (title == title_) return;
  title_ = title;
  glfwSetWindowTitle(window_, title.c_str());
}

Result<Size> Window::fill_display(int number) {
  int count = 0;
  GLFWmonitor** displays = glfwGetMonitors(&count);
  if (number < 0 || number >= count)
    return Error{ErrorCode::kBadInput, fmt::format("there is no display {}: {} {} connected, counted from 0", number, count,
                                                   count == 1 ? "is" : "are")};
  const GLFWvidmode& mode = *glfwGetVideoMode(displays[number]);
  const Size size{mode.width, mode.height};
  glfwSetWindowSizeLimits(window_, GLFW_DONT_CARE, GLFW_DONT_CARE, GLFW_DONT_CARE, GLFW_DONT_CARE);
  glfwSetWindowAttrib(window_, GLFW_AUTO_ICONIFY, GLFW_FALSE);  // it stays when another window is clicked
  glfwSetInputMode(window_, GLFW_CURSOR, GLFW_CURSOR_HIDDEN);
  glfwSetWindowMonitor(window_, displays[number], 0, 0, size.width, size.height, mode.refreshRate);
  Size pixels;
  for (int i = 0; i < 20 && pixels != size; ++i) {  // the display takes a moment; where it is scaled the sizes stay unlike
    glfwWaitEventsTimeout(0.05);
    glfwGetFramebufferSize(window_, &pixels.width, &pixels.height);
  }
  return pixels;
}

Result<void> Window::create_window(const std::string& title, Size size) {
  glfw_words().clear();
  glfwSetErrorCallback([](int, const char* words) {
    std::string& all = glfw_words();
    if (all.find(words) == std::string::npos) all += (all.empty() ? "" : ", ") + std::string(words);
  });
  glfw_ = glfwInit() == GLFW_TRUE;
  if (!glfw_) return no_display();
  // Desktops have had OpenGL 3.0 since 2008; the drivers of some boards have only OpenGL ES.
  constexpr std::pair<int, int> kWays[] = {{GLFW_OPENGL_API, GLFW_NATIVE_CONTEXT_API},
                                           {GLFW_OPENGL_API, GLFW_EGL_CONTEXT_API},
                                           {GLFW_OPENGL_ES_API, GLFW_EGL_CONTEXT_API}};
  for (const auto& [api, creation] : kWays) {
    glfwWindowHint(GLFW_CLIENT_API, api);
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, creation);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    if (window_ == nullptr) window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
  }
  if (window_ == nullptr) return no_driver();
  title_ = title;
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  // ImGui 1.86 loses a key that is pressed and released between two frames; it passes on what it hears.
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int) {
    if (action == GLFW_PRESS) static_cast<Window*>(glfwGetWindowUserPointer(window))->keys_.push_back(key);
  });
  glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
    static_cast<Window*>(glfwGetWindowUserPointer(window))->dropped_.assign(paths, paths + count);
  });
  glfwSetWindowSizeLimits(window_, 640, 420, GLFW_DONT_CARE, GLFW_DONT_CARE);
  float across = 1, down = 1;
  glfwGetWindowContentScale(window_, &across, &down);
  scale_ = std::clamp(across, 1.0f, 4.0f);
  return {};
}

Result<void> Window::create_imgui() {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // the layout is fixed, and no file is left behind
  ImGui::GetIO().LogFilename = nullptr;
  platform_ = ImGui_ImplGlfw_InitForOpenGL(window_, true);
  const bool embedded = glfwGetWindowAttrib(window_, GLFW_CLIENT_API) == GLFW_OPENGL_ES_API;
  renderer_ = ImGui_ImplOpenGL3_Init(embedded ? "#version 300 es" : "#version 130");
  if (!renderer_) return no_driver();
  return {};
}

bool Window::begin() {
  Size size;
  glfwGetFramebufferSize(window_, &size.width, &size.height);
  if (size.empty() || glfwGetWindowAttrib(window_, GLFW_ICONIFIED) != GLFW_FALSE) return false;
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  return true;
}

void Window::end() {
  ImGui::Render();
  const ImVec4& ground = ImGui::GetStyle().Colors[ImGuiCol_WindowBg];
  glClearColor(ground.x, ground.y, ground.z, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  if (std::exchange(wanted_, false)) screenshot_ = drawn_pixels();
  glfwSwapBuffers(window_);
}

}  // namespace duo::app::view
