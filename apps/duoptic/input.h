// What a command was given to look at.
#pragma once

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

/// Opens LEFT and perhaps RIGHT. `rig` wins over the source's own; cameras are asked for the size that it was made for.
///
/// Errors  those of open_pairs()
inline Result<Input> open_input(const std::string& left, const std::string& right, const std::optional<Rig>& rig) {
  Input input{nullptr, rig, {left}};
  if (!right.empty()) input.names.push_back(right);
  DUO_TRY_ASSIGN(input.pairs, open_pairs(left, right, rig ? CameraWish{.size = rig->left.size} : CameraWish{}));
  if (!rig) input.rig = input.pairs->rig();
  return input;
}

}  // namespace duo::app
