// Whether a network can be run.
#pragma once

#include <optional>
#include <string>

#include "nets/net.h"

namespace duo {

/// Why the tensors or outputs cannot be; nothing when they can.
std::optional<std::string> tensors_wrong(const Net& net);

/// Why a layer cannot be run with the tensors that it names, which exist; nothing when it can. Its stage's preconditions hold
/// then.
std::optional<std::string> layer_wrong(const Net& net, const NetLayer& layer);

}  // namespace duo
