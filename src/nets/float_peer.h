// The layers of a network in floating point, by XNNPACK: a peer for benchmarks and tests.
#pragma once

#include <memory>
#include <vector>

#include "duoptic/result.h"
#include "nets/memory_plan.h"
#include "nets/net.h"

struct xnn_operator;
struct pthreadpool;

namespace duo {

/// Fills the input, runs, reads the outputs. Weights are the network's integers in its units, activations are not rounded.
class FloatPeer {
 public:
  /// Takes no better instructions than our engines may where the first one in a process is made.
  ///
  /// Errors  the library refuses a layer, among them sums of results with different numbers of channels; it cannot be held to the
  ///         instructions that our engines are held to
  static Result<std::unique_ptr<FloatPeer>> make(const Net& net, int threads);
  ~FloatPeer();
  FloatPeer(const FloatPeer&) = delete;
  FloatPeer& operator=(const FloatPeer&) = delete;

  /// Values of a tensor, in the network's units.
  float* tensor(int index) { return memory_.data() + plan_.offsets[index]; }
  void run();

 private:
  using Operator = std::unique_ptr<xnn_operator, void (*)(xnn_operator*)>;
  struct MakeLayer;
  explicit FloatPeer(const Net& net);

  MemoryPlan plan_;
  std::vector<float> memory_;
  std::unique_ptr<pthreadpool, void (*)(pthreadpool*)> threads_;
  std::vector<Operator> layers_;
};

}  // namespace duo
