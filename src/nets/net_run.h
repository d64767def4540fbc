// A network with the memory that it runs in.
#pragma once

#include <cstdint>
#include <vector>

#include "core/pool.h"
#include "nets/memory_plan.h"
#include "nets/net.h"

namespace duo {

/// Fills the input, runs, reads the outputs; nothing is allocated after make. The network must outlive it.
///
/// Exact  plain loops and the processor's vectors agree bit for bit, with any number of threads
class NetRun {
 public:
  enum class Loops { kPlain, kVectors };
  NetRun(const Net& net, Loops loops);

  const Net& net() const { return *net_; }
  /// To be filled anew for each run: its memory is used for other tensors, too.
  Tensor16 input() { return tensor(0); }
  void run(Pool& pool);
  /// A tensor that is an output keeps its values until the next run; others are overwritten on the way.
  Tensor16 tensor(int index);
  std::size_t memory_bytes() const;

 private:
  void run_layers(Pool& pool);

  const Net* net_;
  Loops loops_;
  std::vector<int> chains_;  // of each layer
  MemoryPlan plan_;
  Image<std::int16_t> memory_;    // one row
  std::vector<LayerWork> works_;  // the net's layers, packed for the loops
  Image<std::int32_t> packed_;    // their memory, one row
};

}  // namespace duo
