// The rows of a tensor, spread over threads.
#pragma once

#include <algorithm>

#include "core/pool.h"
#include "core/tensor.h"

namespace duo {

/// Calls rows(begin, end) for all rows of `y`. Where less is to be done than threads take to wait for each other, for all at once.
template <class Rows>
void each_tensor_row(Pool& pool, const Tensor16& y, const Rows& rows) {
  constexpr int kGrainValues = 1 << 12;
  pool.rows(y.height(), rows, std::max(1, kGrainValues / (y.width() * y.channels())));
}

}  // namespace duo
