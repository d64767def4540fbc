// Where the tensors of a network lie in one block of memory.
#pragma once

#include <cstddef>
#include <vector>

#include "nets/net.h"

namespace duo {

/// The chain of each layer. Layers of a chain follow each other, and each makes a row from the same rows of what the chain has
/// made before and from what other chains have made; or a channel from the same channels, where threads have channels
/// (core/tensor_parts.h). So threads that have the same rows or channels of each layer need not meet within a chain.
std::vector<int> chains_of(const Net& net);

/// Offsets in int16, multiples of 32. Two tensors share memory only when no chain needs both: a tensor is needed from the chain
/// that writes it (the input from the start) to the last that reads it, an output to the end.
struct MemoryPlan {
  std::vector<std::size_t> offsets;  // one a tensor
  std::size_t count = 0;             // of the block; 64 more may be read past the end
};

/// Greedy by size: the largest tensor first, each at the lowest place that is free while it is needed (Pisarchyk and Lee,
/// "Efficient memory management for deep neural net inference", 2020).
MemoryPlan plan_memory(const Net& net);

}  // namespace duo
