// The column of controls beside the pictures.
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "duoptic/clicks.h"
#include "duoptic/engine.h"
#include "duoptic/player.h"
#include "panels.h"
#include "tracking_options.h"

namespace duo::app::view {

class Sidebar {
 public:
  /// Errors  the matcher's parameters are not known
  static Result<Sidebar> make(std::string source, const EngineOptions& engine, const Player& player, std::string device,
                              float scale);

  /// For the plot.
  void add(const Shown& shown);
  /// In ImGui's current window; true when a screenshot is wanted.
  bool draw(Player& player, Clicks& clicks, ViewChoices& choices, const Shown* shown, const std::string& note);

 private:
  void put_clicks(Player& player, Clicks& clicks, const Shown* shown, const PlayerStatus& status);
  void put_playback(Player& player, const Shown* shown, const PlayerStatus& status);
  void put_seek_bar(Player& player, const Shown* shown, const PlayerStatus& status);
  void put_choices(ViewChoices& choices) const;
  void put_recording(Player& player, const PlayerStatus& status) const;
  void put_outputs(Player& player, const PlayerStatus& status);
  void put_joints(const Shown* shown) const;
  void put_speed() const;
  void put_parameters(Player& player);
  void put_source(Player& player, const PlayerStatus& status) const;

  std::string source_, device_, matcher_;
  float scale_ = 1;
  std::vector<ParameterInfo> parameters_;
  std::vector<int> values_;
  std::vector<RigDoubt> doubts_;
  bool metric_ = true;
  static constexpr std::size_t kTarget = 64;
  int seek_to_ = -1, speed_ = 2;                    // frame, -1 while nothing is dragged; index of the speeds
  std::vector<std::array<char, kTarget>> targets_;  // host:port as its user types it, of each of sink_kinds()
  struct Speed {
    float engine_ms, tracker_ms, latency_ms, interval_ms;
  };
  std::deque<Speed> speeds_;
};

}  // namespace duo::app::view
