#include "nets/memory_plan.h"

#include <algorithm>
#include <numeric>

namespace duo {
namespace {

constexpr std::size_t kPlanBlock = 32;  // int16 in 64 bytes

/// By numbers of layers; the input is there before the first.
struct Needed {
  int first = 0, last = 0;
  bool with(const Needed& other) const { return first <= other.last && other.first <= last; }
};

}  // namespace

MemoryPlan plan_memory(const Net& net) {
  const std::size_t tensors = net.tensors.size();
  std::vector<Needed> needed(tensors);
  for (std::size_t i = 0; i < tensors; ++i) needed[i].first = needed[i].last = static_cast<int>(i) - 1;
  for (std::size_t i = 0; i < net.layers.size(); ++i)
    for (const int read : {net.layers[i].a, net.layers[i].b})
      if (read >= 0) needed[read].last = static_cast<int>(i);
  for (const NetOutput& output : net.outputs) needed[output.tensor].last = static_cast<int>(net.layers.size());

  const auto room = [&](std::size_t i) { return (net.tensors[i].count() + kPlanBlock - 1) / kPlanBlock * kPlanBlock; };
  std::vector<std::size_t> order(tensors), placed;
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater{}, room);

  MemoryPlan plan{std::vector<std::size_t>(tensors), 0};
  for (const std::size_t i : order) {
    std::size_t at = 0;
    for (const std::size_t other : placed) {  // by offset
      if (!needed[i].with(needed[other])) continue;
      if (at + room(i) <= plan.offsets[other]) break;
      at = std::max(at, plan.offsets[other] + room(other));
    }
    plan.offsets[i] = at;
    plan.count = std::max(plan.count, at + room(i));
    placed.insert(std::ranges::upper_bound(placed, at, {}, [&](std::size_t other) { return plan.offsets[other]; }), i);
  }
  return plan;
}

}  // namespace duo
