// What the window shows of cameras without a rig: both pictures, and the way to a rig.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "duoptic/calibration_session.h"
#include "texture.h"
#include "window.h"

namespace duo::app::view {

/// How the page ended.
struct CalibrationEnd {
  std::string rig;       // file that was saved; empty: none
  bool swapped = false;  // again, with left and right the other way round
};

/// Both pictures with focus and exposure in numbers, the guide's words, what of the pictures the board has covered, and the
/// result; a click draws the same row in both.
class CalibrationPage {
 public:
  /// Until a rig was saved, the cameras are to be swapped, or the window is closed or the page left.
  ///
  /// Errors  those of CalibrationSession::start() and of Texture::set()
  static Result<CalibrationEnd> run(Window& window, CalibrationSessionSetup setup, std::unique_ptr<PairSource> pairs,
                                    bool can_swap);

 private:
  CalibrationPage(Window& window, std::unique_ptr<CalibrationSession> session, const Board& board, bool can_swap);
  struct Fit {
    ImVec2 from, to;
  };

  Result<void> show();
  Result<void> draw();
  Result<void> draw_picture(std::size_t side, ImVec2 from, ImVec2 to);
  void draw_board(std::size_t side, const Fit& fit) const;
  void put_words();
  void put_wishes() const;
  void put_result();
  void put_ways_on();
  void put_board();
  void take_keys();
  void save();
  void put_title() const;

  Window& window_;
  std::unique_ptr<CalibrationSession> session_;
  SessionStatus status_;
  std::array<Texture, 2> textures_;
  std::shared_ptr<const Pair> drawn_;  // in textures_
  std::optional<float> row_;           // that was clicked, share of the picture's height
  std::array<char, 32> board_{};
  std::array<char, 256> file_{};
  double square_mm_ = 0;
  std::string problem_, note_;
  const bool can_swap_;
  CalibrationEnd end_;
  bool left_ = false;  // the page
};

}  // namespace duo::app::view
