// What the window shows before there is anything to look at: cameras, files, the synthetic person.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "duoptic/camera_search.h"
#include "duoptic/source_choice.h"
#include "window.h"

namespace duo::app::view {

/// Ways to go on, by a click, by their number's key, or by files that are dropped onto the window.
class StartPage {
 public:
  /// `rig` holds for what is chosen without one.
  StartPage(Window& window, std::string rig) : window_(window), rig_(std::move(rig)) {}

  /// Until something is chosen; nothing when the window is closed. `problem`: why the last choice could not be shown.
  std::optional<SourceChoice> choose(const std::string& problem);

 private:
  struct Way {
    std::string title, name, note;  // title: of those that follow; empty: as before
    SourceChoice choice;
  };
  void set_ways();
  std::optional<SourceChoice> draw();
  std::optional<SourceChoice> take_dropped();

  Window& window_;
  std::shared_ptr<const CameraSearch::Found> cameras_;  // that ways_ are made of
  std::vector<Way> ways_;
  std::string rig_, problem_, no_cameras_;
  SourceChoice dropped_;  // so far: files may come one after the other
};

}  // namespace duo::app::view
