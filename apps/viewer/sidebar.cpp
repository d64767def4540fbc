#include "sidebar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "duoptic/timing.h"
#include "style.h"

namespace duo::app::view {
namespace {

constexpr std::size_t kPlotted = 150;

void title(const char* text) {
  ImGui::Dummy({0, 2});
  ImGui::PushFont(title_font());
  ImGui::TextUnformatted(text);
  ImGui::PopFont();
}

/// Puts trouble at the top, where no small window cuts it off.
void put_trouble(const PlayerStatus& status) {
  for (const std::string* text : {&status.problem, &status.rig_news})
    if (!text->empty()) put_text(kBad, *text);
}

const char* word_of(JointState state) {
  return state == JointState::kSeen ? "seen" : state == JointState::kInferred ? "inferred" : "lost";
}

}  // namespace

Result<Sidebar> Sidebar::make(std::string source, const EngineOptions& engine, const Player& player, std::string device,
                              float scale) {
  Sidebar out;
  out.scale_ = scale;
  out.device_ = std::move(device);
  out.matcher_ = engine.matcher;
  out.source_ = std::move(source);
  DUO_TRY_ASSIGN(out.parameters_, matcher_parameters(engine.matcher, engine.preset));
  for (const ParameterInfo& info : out.parameters_) {
    double value = info.value;
    for (const auto& [name, given] : player.parameters())
      if (name == info.name) value = given;
    out.values_.push_back(static_cast<int>(value));
  }
  out.doubts_ = rig_doubts(player.rig());
  out.metric_ = player.rig().metric;
  return out;
}

void Sidebar::add(const Shown& shown) {
  if (shown.interval_ms <= 0) return;
  speeds_.push_back({static_cast<float>(shown.times.engine_ms),
                     shown.people.empty() ? 0.0f : static_cast<float>(shown.times.tracker_ms),
                     static_cast<float>(shown.latency_ms), static_cast<float>(shown.interval_ms)});
  if (speeds_.size() > kPlotted) speeds_.pop_front();
}

bool Sidebar::draw(Player& player, Clicks& clicks, ViewChoices& choices, const Shown* shown, const std::string& note) {
  const PlayerStatus status = player.status();
  put_clicks(player, clicks, shown, status);
  put_playback(player, shown, status);
  put_recording(player, status);
  put_outputs(player, status);
  put_choices(choices);
  put_joints(shown);
  put_speed();
  put_source(player, status);
  put_parameters(player);
  ImGui::Dummy({0, 4});
  const bool wanted = ImGui::Button("Screenshot", {-1, 0});
  if (!note.empty()) put_text(kFaint, note);
  return wanted;
}

void Sidebar::put_clicks(Player& player, Clicks& clicks, const Shown* shown, const PlayerStatus& status) {
  const bool tracking = shown != nullptr && !shown->people.empty();
  if (!player.asks_for_clicks()) {
    const std::size_t people = tracking ? shown->people.size() : 0;
    ImGui::PushFont(title_font());
    put_text(tracking ? kBox : kFaint, people == 0   ? "Looking for people"
                                       : people == 1 ? "1 person"
                                                     : fmt::format("{} people", people));
    ImGui::PopFont();
    put_trouble(status);
    if (ImGui::Button("Look again", {-1, 0})) player.forget_people();
    return;
  }
  ImGui::PushFont(title_font());
  put_text(clicks.wanted() ? kAccent
           : tracking      ? kBox
                           : kFaint,
           clicks.wanted() ? clicks.prompt()
           : tracking      ? "Tracking"
                           : "Nobody is selected");
  ImGui::PopFont();
  put_trouble(status);
  for (std::size_t i = 0; i < clicks.choices().size(); ++i) {
    if (i > 0) ImGui::SameLine();
    if (ImGui::RadioButton(clicks.choices()[i].c_str(), clicks.choice() == i)) clicks.start(i);
  }
  const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  if (ImGui::Button(clicks.wanted() ? "Undo click" : "Select again", {half, 0})) {
    if (clicks.wanted())
      clicks.undo();
    else
      clicks.start(clicks.choice());
  }
  ImGui::SameLine();
  if (ImGui::Button("Reset", {half, 0})) {
    player.forget_people();
    clicks.start(clicks.choice());
  }
}

void Sidebar::put_playback(Player& player, const Shown* shown, const PlayerStatus& status) {
  title(player.live() ? "Live" : "Playback");
  const float third = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3;
  const bool playing = status.state == PlayState::kPlaying, ended = status.state == PlayState::kEnded;
  if (ImGui::Button(ended ? "Again" : playing ? "Pause" : "Play", {third, 0})) {
    if (ended)
      player.restart();
    else
      player.play(!playing);
  }
  if (player.live()) {
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled(
        "%s", fmt::format("{} dropped, skew {:.1f} ms", status.dropped, shown != nullptr ? shown->skew_ms : 0).c_str());
    if (status.silent) put_text(kBad, "no pictures come: is a camera unplugged?");
    if (!status.event.empty()) put_text(kWarn, status.event);
    return;
  }
  ImGui::SameLine();
  const float sixth = (third - ImGui::GetStyle().ItemSpacing.x) / 2;
  const bool can_seek = !player.still() && shown != nullptr;
  if (ImGui::Button("<", {sixth, 0}) && can_seek) {
    player.play(false);
    player.seek(std::max<std::int64_t>(0, shown->number - 1));
  }
  ImGui::SameLine();
  if (ImGui::Button(">", {sixth, 0}) && !ended) {
    player.play(false);
    player.step();
  }
  ImGui::SameLine();
  if (bool loop = status.loop; ImGui::Checkbox("Loop", &loop)) player.loop(loop);
  put_seek_bar(player, shown, status);
}

/// Where a file is played, and how fast. Its frames are numbered from 0, as in all outputs.
void Sidebar::put_seek_bar(Player& player, const Shown* shown, const PlayerStatus& status) {
  constexpr std::pair<const char*, double> kSpeeds[] = {{"1/4x", 0.25}, {"1/2x", 0.5}, {"1x", 1}, {"2x", 2}, {"4x", 4}};
  const int now = shown != nullptr ? static_cast<int>(shown->number) : 0, last = static_cast<int>(player.count()) - 1;
  const float beside = 76 * scale_;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - beside - ImGui::GetStyle().ItemSpacing.x);
  const char* const state = status.state == PlayState::kEnded    ? ", the end"
                            : status.state == PlayState::kPaused ? ", paused"
                                                                 : "";
  const std::string format = last > 0 ? fmt::format("%d of {}{}", last, state) : fmt::format("%d{}", state);
  int at = seek_to_ >= 0 ? seek_to_ : now;
  if (ImGui::SliderInt("##seek", &at, 0, std::max(last, now), format.c_str(), ImGuiSliderFlags_AlwaysClamp)) seek_to_ = at;
  if (ImGui::IsItemDeactivatedAfterEdit() && !player.still() && last > 0) player.seek(seek_to_);
  if (!ImGui::IsItemActive()) seek_to_ = -1;
  ImGui::SameLine();
  ImGui::SetNextItemWidth(beside);
  if (!ImGui::BeginCombo("##speed", kSpeeds[speed_].first)) return;
  for (int i = 0; i < static_cast<int>(std::size(kSpeeds)); ++i)
    if (ImGui::Selectable(kSpeeds[i].first, i == speed_)) {
      speed_ = i;
      player.set_speed(kSpeeds[i].second);
    }
  ImGui::EndCombo();
}

/// How depth is coloured, which wall is measured, and what the last panel shows.
void Sidebar::put_choices(ViewChoices& choices) const {
  if (!ImGui::CollapsingHeader("Pictures")) return;
  const float label = 110 * scale_;
  const auto line = [&](const char* name) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine(label);
    ImGui::SetNextItemWidth(-1);
  };
  int colors = static_cast<int>(choices.colors);
  line("colours");
  if (ImGui::Combo("##colours", &colors, "Turbo\0Cividis\0gray\0")) choices.colors = static_cast<DepthColors>(colors);
  line("range");
  if (int own = choices.own_range ? 1 : 0; ImGui::Combo("##range", &own, "of the scene\0chosen\0"))
    choices.own_range = own != 0;
  if (choices.own_range) {
    line("from, to");
    ImGui::DragFloatRange2("##from", &choices.near_m, &choices.far_m, 0.02f, 0.1f, 50, "%.2f m", "%.2f m",
                           ImGuiSliderFlags_AlwaysClamp);
    choices.far_m = std::max(choices.far_m, choices.near_m + 0.05f);
  }
  line("last panel");
  if (int pair = choices.rectified_pair ? 1 : 0; ImGui::Combo("##last", &pair, "hue\0rectified pair\0"))
    choices.rectified_pair = pair != 0;
  line("wall, true");
  ImGui::InputFloat("##wall", &choices.wall_m, 0, 0, choices.wall_m > 0 ? "%.3f m" : "not known");
}

/// A button, and beside it a red dot and how long it has been on.
void Sidebar::put_recording(Player& player, const PlayerStatus& status) const {
  if (player.still()) return;
  const RecordingStatus now = player.recording();
  const float third = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3;
  if (ImGui::Button(now.on ? "Stop" : "Record", {third, 0}) && (now.on || status.state != PlayState::kEnded))
    player.record(!now.on);
  const auto seconds = static_cast<int>(now.length_s);
  const std::string amount = fmt::format("{}:{:02}, {} pairs, {:.1f} MB", seconds / 60, seconds % 60, now.pairs,
                                         static_cast<double>(now.bytes) * 1e-6);
  if (now.on) {
    ImGui::SameLine();
    const float size = ImGui::GetFrameHeight();
    const ImVec2 from = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddCircleFilled({from.x + size / 2, from.y + size / 2}, size / 4, kBad);
    ImGui::Dummy({size, size});
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(amount.c_str());
  }
  if (!now.problem.empty())
    put_text(kBad, now.problem);
  else if (!now.name.empty())
    put_text(kFaint, now.on ? "into " + now.name : now.pairs > 0 ? now.name + ": " + amount : "nothing recorded: no pair came");
}

/// A box per kind of output; beside it where the tracked frames go and how many went there.
void Sidebar::put_outputs(Player& player, const PlayerStatus& status) {
  if (!ImGui::CollapsingHeader("Outputs")) return;
  const auto kinds = sink_kinds();
  if (targets_.empty())
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      const std::string given = status.outputs[i].name.empty() ? kinds[i].target : status.outputs[i].name;
      std::snprintf(targets_.emplace_back().data(), kTarget, "%s", given.c_str());
    }
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const OutputStatus& output = status.outputs[i];
    ImGui::PushID(static_cast<int>(i));
    if (bool on = output.on; ImGui::Checkbox(kinds[i].label, &on)) player.put_out(i, on, targets_[i].data());
    if (!kinds[i].is_file() && !output.on) {
      ImGui::SameLine(110 * scale_);
      ImGui::SetNextItemWidth(-1);
      ImGui::InputText("##target", targets_[i].data(), kTarget);
    }
    if (!output.name.empty()) put_text(kFaint, fmt::format("{}: {} frames", output.name, output.frames));
    ImGui::PopID();
  }
}

void Sidebar::put_joints(const Shown* shown) const {
  if (shown == nullptr || shown->people.empty()) return;
  title(metric_ ? "Joints, metres" : "Joints, not metric");
  if (!ImGui::BeginTable("joints", 6)) return;
  const std::pair<const char*, float> columns[] = {{"", 2.0f}, {"", 1.3f}, {"x", 1},
                                                   {"y", 1},   {"z", 1},   {metric_ ? "\u00b1 cm" : "\u00b1", 0.9f}};
  for (const auto& [name, share] : columns) ImGui::TableSetupColumn(name, ImGuiTableColumnFlags_WidthStretch, share);
  ImGui::TableHeadersRow();
  for (const Person& person : shown->people) {
    if (shown->people.size() > 1) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      put_text(kFaint, fmt::format("person {}", person.id));
    }
    for (std::size_t j = 0; j < person.count(); ++j) {
      const Joint& k = person.joints[j];
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      std::string joint(name_of(person.skeleton->joints[j].id));  // with its side
      std::ranges::replace(joint, '_', ' ');
      ImGui::TextUnformatted(joint.c_str());
      ImGui::TableNextColumn();
      ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(color_of(k.state)), "%s", word_of(k.state));
      if (k.state == JointState::kLost) continue;
      for (const double value : {k.p_in_rig_m.x, k.p_in_rig_m.y, k.p_in_rig_m.z}) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(fmt::format("{:.2f}", value).c_str());
      }
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(fmt::format("{:.1f}", 100 * k.sigma_m()).c_str());
    }
  }
  ImGui::EndTable();
}

/// Engine and tracker as stacked bars, latency as a line, and the 33 ms of a camera's frame.
void Sidebar::put_speed() const {
  title("Speed");
  if (speeds_.empty()) return ImGui::TextDisabled("nothing played yet");
  std::vector<double> engine, tracker, latency, interval;
  for (const Speed& s : speeds_) {
    engine.push_back(s.engine_ms);
    tracker.push_back(s.tracker_ms);
    latency.push_back(s.latency_ms);
    interval.push_back(s.interval_ms);
  }
  constexpr ImU32 kEngine = IM_COL32(64, 132, 214, 255), kTracker = IM_COL32(236, 151, 60, 255);
  const float width = ImGui::GetContentRegionAvail().x, height = 64 * scale_;
  const ImVec2 from = ImGui::GetCursorScreenPos(), to = {from.x + width, from.y + height};
  ImGui::Dummy({width, height});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(from, to, IM_COL32(18, 20, 25, 255), 4 * scale_);
  const float most = std::clamp(1.15f * static_cast<float>(*std::max_element(latency.begin(), latency.end())), 50.0f, 500.0f);
  const auto y_of = [&](float ms) { return to.y - height * std::min(ms / most, 1.0f); };
  const float bar = width / static_cast<float>(kPlotted);
  float x = to.x - bar * static_cast<float>(speeds_.size());
  ImVec2 before;
  for (const Speed& s : speeds_) {
    list.AddRectFilled({x, y_of(s.engine_ms)}, {x + bar, to.y}, kEngine);
    list.AddRectFilled({x, y_of(s.engine_ms + s.tracker_ms)}, {x + bar, y_of(s.engine_ms)}, kTracker);
    const ImVec2 at = {x + bar / 2, y_of(s.latency_ms)};
    if (&s != &speeds_.front()) list.AddLine(before, at, kText, 1.2f * scale_);
    before = at;
    x += bar;
  }
  constexpr float kCameraFrame_ms = 1000.0f / 30;
  dashed_line(list, {from.x, y_of(kCameraFrame_ms)}, {to.x, y_of(kCameraFrame_ms)}, IM_COL32(255, 255, 255, 90), 1, 4 * scale_);
  list.AddText({from.x + 5 * scale_, y_of(kCameraFrame_ms) - 17 * scale_}, kFaint, "33 ms");
  const double ms = median_of(interval);
  ImGui::TextUnformatted(fmt::format("{:.1f} frames/s, {:.0f} ms latency", ms > 0 ? 1000 / ms : 0, median_of(latency)).c_str());
  put_text(kEngine, fmt::format("engine {:.1f} ms", median_of(engine)));
  ImGui::SameLine();
  put_text(kTracker, fmt::format("tracker {:.1f} ms", median_of(tracker)));
}

void Sidebar::put_parameters(Player& player) {
  ImGui::Dummy({0, 2});
  if (!ImGui::CollapsingHeader(("Matcher " + matcher_ + "###matcher").c_str())) return;
  bool changed = false;
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {4 * scale_, 2 * scale_});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * scale_, 4 * scale_});
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const ParameterInfo& info = parameters_[i];
    const std::string format = info.unit.empty() ? "%d" : "%d " + info.unit;
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", info.name.c_str());
    bool hovered = ImGui::IsItemHovered();
    ImGui::SameLine(128 * scale_);
    ImGui::SetNextItemWidth(-1);
    const std::string id = "##" + info.name;
    if (info.min == 0 && info.max == 1) {
      bool on = values_[i] != 0;
      changed = ImGui::Checkbox(id.c_str(), &on) || changed;
      values_[i] = on ? 1 : 0;
    } else {
      ImGui::SliderInt(id.c_str(), &values_[i], static_cast<int>(info.min), static_cast<int>(info.max), format.c_str(),
                       ImGuiSliderFlags_AlwaysClamp);
      changed = ImGui::IsItemDeactivatedAfterEdit() || changed;
    }
    hovered = ImGui::IsItemHovered() || hovered;
    if (hovered) ImGui::SetTooltip("%s", info.help.c_str());
  }
  ImGui::PopStyleVar(2);
  if (ImGui::Button("Preset's values", {-1, 0})) {
    for (std::size_t i = 0; i < parameters_.size(); ++i) values_[i] = static_cast<int>(parameters_[i].value);
    changed = true;
  }
  if (!changed) return;
  std::vector<std::pair<std::string, double>> shown;  // all: what is not named may have another value where people are tracked
  for (std::size_t i = 0; i < parameters_.size(); ++i) shown.emplace_back(parameters_[i].name, values_[i]);
  player.set(shown);
}

void Sidebar::put_source(Player& player, const PlayerStatus& status) const {
  if (!ImGui::CollapsingHeader("Source and rig", ImGuiTreeNodeFlags_DefaultOpen)) return;
  const TrackHeader& header = player.header();
  const Rig& rig = player.rig();
  put_text(kText, source_);
  put_fact("pictures", fmt::format("{}x{}, {:.0f} a second, {}", header.size.width, header.size.height, 1 / header.frame_s,
                                   player.live() ? "live" : "from files"));
  put_fact("focal lengths", fmt::format("{:.1f} and {:.1f} px", rig.left.fx_px, rig.right.fx_px));
  put_fact("baseline", rig.metric ? fmt::format("{:.1f} mm", 1000 * rig.baseline_m()) : "a guess: not metric");
  put_fact("engine", header.engine);
  put_fact("window", device_);
  for (const RigDoubt& doubt : doubts_) put_text(color_of(doubt.verdict), doubt.what);
  if (status.checking_rig)
    ImGui::TextDisabled("looking at the pictures ...");
  else if (ImGui::Button("Does the rig fit this scene?", {-1, 0}))
    player.check_rig();
  if (!status.health) return;
  if (!*status.health) return put_text(kBad, status.health->error().what);
  const SceneHealth& health = **status.health;
  put_text(color_of(health.verdict), fmt::format("By this scene: {}", name_of(health.verdict)));
  put_fact("rows", fmt::format("{:.2f} px off; good below {}", health.row_px, kGoodRow_px));
  put_fact("pan", fmt::format("{:.1f} \u00b1 {:.1f} px", health.pan_px, health.pan_sigma_px));
  put_fact("points", fmt::format("{} in {:.0f} % of the picture", health.points, 100 * health.covered));
}

}  // namespace duo::app::view
