// The rows of a tensor, spread over threads.
#pragma once

#include "core/pool.h"
#include "core/tensor.h"

namespace duo {

/// Calls rows(begin, end) for all rows of `y`. A thread gets the same rows of all tensors of one height, so that a layer whose
/// rows are made from the same rows of the layer before need not wait for the other threads.
template <class Rows>
void each_tensor_row(Pool& pool, const Tensor16& y, const Rows& rows) {
  pool.rows(y.height(), rows);
}

}  // namespace duo
