#include "pattern_screen.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "texture.h"
#include "window.h"

namespace duo::app::view {
namespace {

class FullScreen final : public LightScreen {
 public:
  explicit FullScreen(std::unique_ptr<Window> window) : window_(std::move(window)) {}

  Result<bool> show(View<const std::uint8_t> picture) override {
    Image<Rgb8> gray(picture.size());
    for (int y = 0; y < picture.height(); ++y)
      for (int x = 0; x < picture.width(); ++x) gray.at(y, x) = {picture.at(y, x), picture.at(y, x), picture.at(y, x)};
    DUO_TRY(texture_.set(std::as_const(gray).view()));
    Window::wait(0.001);  // hears keys
    const std::vector<int> keys = window_->keys();
    const auto pressed = [&](int key) { return std::find(keys.begin(), keys.end(), key) != keys.end(); };
    if (window_->closing() || pressed(GLFW_KEY_ESCAPE) || pressed(GLFW_KEY_Q)) return false;
    if (!window_->begin())
      return Error{ErrorCode::kUnsupported, "cannot show patterns: the window is hidden; leave it open until all are shown"};
    texture_.draw(*ImGui::GetBackgroundDrawList(), {0, 0}, ImGui::GetIO().DisplaySize);
    window_->end();
    return true;
  }

 private:
  std::unique_ptr<Window> window_;
  Texture texture_;  // after the window, whose memory it is in
};

}  // namespace

Result<PatternScreen> open_pattern_screen(int display) {
  DUO_TRY_ASSIGN(std::unique_ptr<Window> window, Window::open("duoptic truth", {800, 600}));
  DUO_TRY_ASSIGN(const Size size, window->fill_display(display));
  return PatternScreen{std::make_unique<FullScreen>(std::move(window)), size};
}

}  // namespace duo::app::view
