#include "nets/memory_plan.h"

#include <algorithm>
#include <numeric>

namespace duo {
namespace {

constexpr std::size_t kPlanBlock = 32;  // int16 in 64 bytes

/// By numbers of chains; the input is there before the first.
struct Needed {
  int first = 0, last = 0;
  bool with(const Needed& other) const { return first <= other.last && other.first <= last; }
};

bool works_on_single_pixels(const LayerWork& work) {
  return std::holds_alternative<Matmul16>(work) || std::holds_alternative<Add16>(work);
}

}  // namespace

std::vector<int> chains_of(const Net& net) {
  std::vector<int> chains;
  for (std::size_t i = 0; i < net.layers.size(); ++i) {
    const Size size = net.tensors[net.layers[i].y].size;
    // A tensor of one row is divided among threads by its channels.
    const bool goes_on =
        i > 0 && works_on_single_pixels(net.layers[i].work) && size.height > 1 && size == net.tensors[net.layers[i - 1].y].size;
    chains.push_back(i == 0 ? 0 : chains.back() + (goes_on ? 0 : 1));
  }
  return chains;
}

MemoryPlan plan_memory(const Net& net) {
  const std::size_t tensors = net.tensors.size();
  const std::vector<int> chains = chains_of(net);
  std::vector<Needed> needed(tensors, Needed{-1, -1});
  for (std::size_t i = 0; i < net.layers.size(); ++i) {
    needed[net.layers[i].y] = {chains[i], chains[i]};
    for (const int read : {net.layers[i].a, net.layers[i].b})
      if (read >= 0) needed[read].last = chains[i];
  }
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
