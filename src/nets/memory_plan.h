// Where the tensors of a network lie in one block of memory.
#pragma once

#include <cstddef>
#include <vector>

#include "nets/net.h"

namespace duo {

/// Offsets in int16, multiples of 32. Two tensors share memory only when no layer needs both: a tensor is needed from the layer
/// that writes it (the input from the start) to the last that reads it, an output to the end.
struct MemoryPlan {
  std::vector<std::size_t> offsets;  // one a tensor
  std::size_t count = 0;             // of the block; 64 more may be read past the end
};

/// Greedy by size: the largest tensor first, each at the lowest place that is free while it is needed (Pisarchyk and Lee,
/// "Efficient memory management for deep neural net inference", 2020).
MemoryPlan plan_memory(const Net& net);

}  // namespace duo
