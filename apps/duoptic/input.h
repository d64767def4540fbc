// What a command was given to look at.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "duoptic/source.h"

namespace duo::app {

struct Input {
  std::unique_ptr<PairSource> pairs;
  std::optional<Rig> rig;
  std::vector<std::string> names;  // as the user wrote them, left first
};

/// The option --skew-ms: two videos do not tell when their pictures were taken.
inline void add_skew_option(CLI::App& app, double& skew_ms) {
  app.add_option("--skew-ms", skew_ms, "Of two videos: how much later than the left ones the right pictures were taken")
      ->type_name("MS")
      ->check(CLI::Range(-100.0, 100.0));
}

/// Opens LEFT and perhaps RIGHT. `rig` wins over the source's own; cameras are asked for the size that it was made for.
///
/// Errors  those of open_pairs(); a skew for what brings its own times
inline Result<Input> open_input(const std::string& left, const std::string& right, const std::optional<Rig>& rig,
                                double skew_ms = 0) {
  Input input{nullptr, rig, {left}};
  if (!right.empty()) input.names.push_back(right);
  DUO_TRY_ASSIGN(input.pairs, open_pairs(left, right, rig ? CameraWish{.size = rig->left.size} : CameraWish{}));
  if (!rig) input.rig = input.pairs->rig();
  if (skew_ms == 0) return input;
  if (right.empty() || input.pairs->live())
    return Error{
        ErrorCode::kUnsupported,
        fmt::format("cannot use --skew-ms with {}: cameras and recordings bring their own times; it is for two videos", left)};
  input.pairs = with_skew(std::move(input.pairs), std::llround(skew_ms * 1e6));
  return input;
}

}  // namespace duo::app
