#include "start.h"

#include <fmt/format.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <filesystem>

#include "duoptic/interrupt.h"
#include "style.h"

namespace duo::app::view {
namespace {

std::string short_name(const std::string& path) {
  return path.starts_with('/') ? std::filesystem::path(path).filename().string() : path;
}

std::string words_of(const SourceChoice& choice) {
  std::string out = short_name(choice.left);
  if (!choice.right.empty()) out += ", " + short_name(choice.right);
  return out;
}

/// Why there are not two cameras that go together, and what to do.
std::string why_no_pair(const CameraSearch::Found& cameras) {
  if (!cameras) return cameras.error().what;
  if (cameras->size() == 1)
    return fmt::format("{}, {}, is the only camera: plug a second one in", source_name((*cameras)[0]), (*cameras)[0].name);
  return "the cameras have no size and format in common: duoptic cameras lists what they give";
}

}  // namespace

void StartPage::set_ways() {
  std::vector<Way> out;
  out.push_back({"Without cameras", "A rendered person", "is tracked live", {"synthetic", "", ""}});
  const std::vector<CameraPair> pairs =
      cameras_ && *cameras_ ? camera_pairs(**cameras_, CameraWish()) : std::vector<CameraPair>();
  no_cameras_ = !pairs.empty() ? "" : cameras_ ? why_no_pair(*cameras_) : "still looking for them";
  std::string title = "Cameras";
  for (const CameraPair& pair : pairs) {
    const CameraInfo &left = (**cameras_)[pair.left], &right = (**cameras_)[pair.right];
    out.push_back({std::exchange(title, ""),
                   fmt::format("{} and {}", source_name(left), source_name(right)),
                   left.name == right.name ? "two of " + left.name : left.name + ", " + right.name,
                   {source_name(left), source_name(right), ""}});
  }
  title = "Recent";
  for (const SourceChoice& choice : recent_sources())
    if (choice.left != "synthetic")
      out.push_back(
          {std::exchange(title, ""), words_of(choice), std::filesystem::path(choice.left).parent_path().string(), choice});
  ways_ = std::move(out);
}

std::optional<SourceChoice> StartPage::choose(const std::string& problem) {
  constexpr std::chrono::milliseconds kPatience(300);  // so that what is there stands in the first picture
  problem_ = problem;
  CameraSearch search(Window::wake);
  cameras_ = search.found(kPatience);
  set_ways();
  window_.set_title("duoptic view: choose a source");
  while (!window_.closing() && !Interrupt::asked()) {
    if (auto news = search.found(); news != cameras_) cameras_ = std::move(news), set_ways();
    Window::wait(ImGui::IsAnyMouseDown() ? 0.01 : 0.1);
    for (const int key : window_.keys()) {
      if (key == GLFW_KEY_Q) return std::nullopt;
      if (key == GLFW_KEY_F12) window_.want_screenshot();
      const auto number = static_cast<std::size_t>(key - GLFW_KEY_1);
      if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9 && number < ways_.size()) return ways_[number].choice;
    }
    if (auto dropped = take_dropped()) return dropped;
    if (!window_.begin()) continue;
    auto chosen = draw();
    window_.end();
    window_.write_screenshot();
    if (chosen && chosen->rig.empty()) chosen->rig = rig_;
    if (chosen) return chosen;
  }
  return std::nullopt;
}

/// A rig that comes alone waits for pictures, and they for it.
std::optional<SourceChoice> StartPage::take_dropped() {
  const std::vector<std::string> files = window_.dropped();
  if (files.empty()) return std::nullopt;
  const auto choice = choose_files({files.begin(), files.end()});
  problem_ = choice ? "" : choice.error().what;
  if (!choice) return std::nullopt;
  if (!choice->rig.empty()) rig_ = choice->rig;
  if (!choice->left.empty()) dropped_ = *choice;
  if (dropped_.left.empty()) return std::nullopt;
  return SourceChoice{dropped_.left, dropped_.right, rig_};
}

std::optional<SourceChoice> StartPage::draw() {
  std::optional<SourceChoice> out;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float scale = window_.scale(), width = std::min(size.x - 40 * scale, 620 * scale);
  ImGui::SetNextWindowPos({(size.x - width) / 2, 20 * scale});
  ImGui::SetNextWindowSize({width, size.y - 40 * scale});
  ImGui::Begin("start", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  put_text(kText, "What shall be looked at?", title_font());
  put_text(kFaint,
           "Drop two videos or one recording here, with their rig file if there is one; or choose by a click or a number's "
           "key. What has "
           "no rig is calibrated first.");
  if (!rig_.empty()) put_text(kAccent, "rig: " + short_name(rig_));
  if (!problem_.empty()) put_text(kBad, problem_);
  ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, {0, 0.5f});
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    const Way& way = ways_[i];
    if (!way.title.empty()) ImGui::Dummy({0, 6 * scale}), put_text(kText, way.title, title_font());
    if (ImGui::Button(fmt::format("{}   {}##{}", i + 1, way.name, i).c_str(), {0.55f * width, 0})) out = way.choice;
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", way.note.c_str());
  }
  ImGui::PopStyleVar();
  if (!no_cameras_.empty()) {
    ImGui::Dummy({0, 6 * scale});
    put_text(kText, "No pair of cameras", title_font());
    put_text(kFaint, no_cameras_ + ". What is plugged in appears here.");
  }
  ImGui::End();
  return out;
}

}  // namespace duo::app::view
