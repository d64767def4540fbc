// A window that ImGui draws into.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "duoptic/image.h"
#include "duoptic/result.h"

struct GLFWwindow;

namespace duo::app::view {

/// "duoptic_view_001" and so on in the working folder, with this ending; a name that no file has.
std::string free_name(const char* ending);

/// GLFW's window, its OpenGL context and ImGui's, one of each in a process.
///
/// Threads  the main thread's; wake() is anyone's
class Window {
 public:
  /// Errors  no display; no driver for OpenGL 3.0 or OpenGL ES 3.0
  static Result<std::unique_ptr<Window>> open(const std::string& title, Size size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Until something happens, or the time is over.
  static void wait(double seconds);
  static void wake();

  bool closing() const;
  /// What was pressed since the last call, as GLFW_KEY_*; without those that ImGui's text fields take.
  std::vector<int> keys();
  /// Files that were dropped onto it since the last call.
  std::vector<std::string> dropped() { return std::exchange(dropped_, {}); }
  void set_title(const std::string& title);
  /// Covers a display, counted from 0, without frame and pointer; the size of its pixels.
  ///
  /// Errors  there is no such display
  Result<Size> fill_display(int number);
  /// How much larger than 96 dots per inch letters and lines shall be.
  float scale() const { return scale_; }
  /// Who draws, in the driver's words.
  std::string device() const;

  /// Starts ImGui's frame; false while there is nothing to draw on (minimised).
  bool begin();
  /// Shows what ImGui was told since begin().
  void end();
  /// The next end() keeps what it shows; then screenshot() has it once.
  void want_screenshot() { wanted_ = true; }
  std::optional<Image<Rgb8>> screenshot() { return std::exchange(screenshot_, std::nullopt); }
  /// Writes it under a free_name(): what to say of that; empty where there is none.
  std::string write_screenshot();

 private:
  Window() = default;
  Result<void> create_window(const std::string& title, Size size);
  Result<void> create_imgui();

  bool glfw_ = false, platform_ = false, renderer_ = false;  // what was started; the latter two are ImGui's
  GLFWwindow* window_ = nullptr;
  float scale_ = 1;
  std::string title_;
  std::vector<int> keys_;
  std::vector<std::string> dropped_;
  bool wanted_ = false;
  std::optional<Image<Rgb8>> screenshot_;
};

}  // namespace duo::app::view
