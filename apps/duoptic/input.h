// What a command was given to look at.
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "command.h"
#include "duoptic/source.h"

namespace duo::app {

/// LEFT and perhaps RIGHT, their rig, and what the command line says of them that they do not say themselves.
struct InputOptions {
  std::string left, right, rig;  // rig: a file; empty: the source's own
  double skew_ms = 0;
  std::optional<ViewLayout> layout = {};

  void add_to(CLI::App& app) {
    app.add_option("--skew-ms", skew_ms,
                   "Of two videos: how much later than their times say the right pictures were taken; the right camera began "
                   "later: more than 0")
        ->type_name("MS")
        ->check(within(-kMostSkew_ms, kMostSkew_ms));
    app.add_option("--layout", layout, "Of one file with both views: where they are; without it what the file says")
        ->transform(CLI::Transformer(std::map<std::string, ViewLayout>{{"side-by-side", ViewLayout::kSideBySide},
                                                                       {"right-left", ViewLayout::kRightLeft},
                                                                       {"top-bottom", ViewLayout::kTopBottom},
                                                                       {"bottom-top", ViewLayout::kBottomTop}}))
        ->transform(CLI::IsMember({"side-by-side", "right-left", "top-bottom", "bottom-top"}))  // looks before the one above
        ->type_name("side-by-side|right-left|top-bottom|bottom-top");
  }
  /// Cameras are asked for the size that the rig was made for.
  PairWish wish(const std::optional<Rig>& of = std::nullopt) const {
    PairWish wish{.skew_ns = std::llround(skew_ms * 1e6), .layout = layout};
    if (of) wish.cameras.size = of->left.size;
    return wish;
  }
  /// Errors  those of load_rig() and open_input()
  Result<Input> open() const {
    std::optional<Rig> given;
    if (!rig.empty()) {
      DUO_TRY_ASSIGN(given, load_rig(rig));
    }
    return open_input(left, right, given, wish());
  }

 private:
  static constexpr double kMostSkew_ms = 1e9;  // eleven days
};

}  // namespace duo::app
