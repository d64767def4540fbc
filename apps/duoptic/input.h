// What a command was given to look at.
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "duoptic/source.h"

namespace duo::app {

struct Input {
  std::unique_ptr<PairSource> pairs;
  std::optional<Rig> rig;
  std::vector<std::string> names;  // as the user wrote them, left first
};

/// What the command line says of LEFT and RIGHT that they do not say themselves.
struct InputOptions {
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
  PairWish wish(const std::optional<Rig>& rig = std::nullopt) const {
    PairWish wish{.skew_ns = std::llround(skew_ms * 1e6), .layout = layout};
    if (rig) wish.cameras.size = rig->left.size;
    return wish;
  }

 private:
  static constexpr double kMostSkew_ms = 1e9;  // eleven days
};

/// Opens LEFT and perhaps RIGHT. `rig` wins over the source's own.
///
/// Errors  those of open_pairs(); half of LEFT alone is half of what the rig was made for: RIGHT is missing
inline Result<Input> open_input(const std::string& left, const std::string& right, const std::optional<Rig>& rig,
                                const InputOptions& options = {}) {
  Input input{nullptr, rig, {left}};
  if (!right.empty()) input.names.push_back(right);
  DUO_TRY_ASSIGN(input.pairs, open_pairs(left, right, options.wish(rig)));
  if (!rig) input.rig = input.pairs->rig();
  const Size half = input.pairs->size();
  if (right.empty() && rig &&
      (rig->left.size == Size{2 * half.width, half.height} || rig->left.size == Size{half.width, 2 * half.height}))
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot use {} as two views: it has the {}x{} pixels that one view of the rig has; give "
                             "LEFT and RIGHT, or the rig of its halves",
                             left, rig->left.size.width, rig->left.size.height)};
  return input;
}

}  // namespace duo::app
