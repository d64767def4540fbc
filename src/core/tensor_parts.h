// What each thread makes of a tensor.
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

/// Channels come in groups of so many: a block of a packed layer's outputs.
inline constexpr int kChannelGroup = 16;

/// Whether the channels of a result are spread over threads, not its rows: seven rows would make one of two threads wait for
/// the other, two rows the third and the fourth.
inline bool divided_by_channels(Size size, int channels) {
  constexpr int kFewRows = 7, kManyChannels = 7 * kChannelGroup;
  return size.height == 1 || (size.height <= kFewRows && channels >= kManyChannels);
}

/// Calls part(row_begin, row_end, channel_begin, channel_end) for all of `y`. Tensors of equal channels that are divided by
/// channels are divided alike.
template <class Part>
void each_tensor_part(Pool& pool, const Tensor16& y, const Part& part) {
  if (divided_by_channels(y.size(), y.channels()))
    pool.rows(
        y.channels(), [&](int begin, int end) { part(0, y.height(), begin, end); }, kChannelGroup);
  else
    pool.rows(y.height(), [&](int begin, int end) { part(begin, end, 0, y.channels()); });
}

}  // namespace duo
