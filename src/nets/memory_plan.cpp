#include "nets/memory_plan.h"

#include <algorithm>
#include <numeric>

#include "core/tensor_parts.h"

namespace duo {
namespace {

constexpr std::size_t kPlanBlock = 32;  // int16 in 64 bytes

/// By numbers of chains; the input is there before the first.
struct Needed {
  int first = 0, last = 0;
  bool with(const Needed& other) const { return first <= other.last && other.first <= last; }
};

template <class... Works>
bool is_one_of(const LayerWork& work) {
  return (std::holds_alternative<Works>(work) || ...);
}

/// As the layers' stages spread them over threads.
bool by_channels(const LayerWork& work, const NetTensor& y) {
  return is_one_of<Matmul16, Depthwise16, Add16, SumPixels16>(work) && divided_by_channels(y.size, y.channels);
}

}  // namespace

std::vector<int> chains_of(const Net& net) {
  std::vector<int> chains;
  for (std::size_t i = 0; i < net.layers.size(); ++i) {
    if (i == 0) {
      chains.push_back(0);
      continue;
    }
    const NetLayer &before = net.layers[i - 1], &layer = net.layers[i];
    const NetTensor &made = net.tensors[before.y], &y = net.tensors[layer.y];
    const bool channels = by_channels(layer.work, y);
    const bool goes_on = channels == by_channels(before.work, made) &&
                         (channels ? is_one_of<Depthwise16, Add16, SumPixels16>(layer.work) && y.channels == made.channels
                                   : is_one_of<Matmul16, Add16>(layer.work) && y.size == made.size);
    chains.push_back(chains.back() + (goes_on ? 0 : 1));
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
