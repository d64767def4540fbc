// Plain rows in parallel: counting into a table is no work for lanes.

#include <array>
#include <mutex>

#include "core/check.h"
#include "stages/sample_depth/sample_depth.h"

namespace duo::simd {
namespace {

using Counts = std::array<std::int32_t, 256>;  // one a byte
constexpr int kRanks = 3;

void add(const Counts& part, Counts& out) {
  for (std::size_t i = 0; i < out.size(); ++i) out[i] += part[i];
}

/// The byte in which the value of this rank lies; `rank` becomes its rank among the values there.
std::uint8_t select(const Counts& counts, std::int64_t& rank) {
  std::size_t i = 0;
  while (rank >= counts[i]) rank -= counts[i++];
  return static_cast<std::uint8_t>(i);
}

template <class F>
void each_disparity(View<const std::uint16_t> d_q4, const Area& area, const Window& bounds, int from, int to, F&& f) {
  each_row(area, bounds, bounds.y + from, bounds.y + to, [&](int y, int begin, int end) {
    const std::uint16_t* d = d_q4.row(y);
    for (int x = area.next_marked(y, begin, end); x < end; x = area.next_marked(y, x + 1, end)) f(d[x]);
  });
}

}  // namespace

DepthSample sample_depth(Pool& pool, View<const std::uint16_t> d_q4, const Area& area) {
  DUO_CHECK(area.marks.empty() || area.marks.size() == d_q4.size());
  const Window bounds = area.bounds(d_q4.size());
  DepthSample out;
  Counts high{};
  std::mutex merge;
  pool.rows(bounds.height, [&](int from, int to) {
    Counts mine{};
    std::int32_t count = 0, known = 0;
    each_disparity(d_q4, area, bounds, from, to, [&](std::uint16_t d) {
      ++count;
      known += d != Disparity::kNone;
      ++mine[d >> 8];  // kNone too: the largest value, it lies beyond every rank
    });
    const std::lock_guard lock(merge);
    out.count += count;
    out.known += known;
    add(mine, high);
  });
  if (out.known == 0) return out;

  const std::int64_t last = out.known - 1;
  std::int64_t ranks[kRanks] = {last / 4, last / 2, 3 * last / 4};
  std::uint8_t bytes[kRanks];
  std::array<std::uint8_t, 256> slot_of;  // the ranks mostly share a high byte, and then a table; the last one takes the rest
  slot_of.fill(kRanks);
  for (int i = kRanks - 1; i >= 0; --i) {
    bytes[i] = select(high, ranks[i]);
    slot_of[bytes[i]] = static_cast<std::uint8_t>(i);
  }
  std::array<Counts, kRanks + 1> low{};
  pool.rows(bounds.height, [&](int from, int to) {
    std::array<Counts, kRanks + 1> mine{};
    each_disparity(d_q4, area, bounds, from, to, [&](std::uint16_t d) { ++mine[slot_of[d >> 8]][d & 255]; });
    const std::lock_guard lock(merge);
    for (std::size_t i = 0; i < kRanks; ++i) add(mine[i], low[i]);
  });
  const auto value = [&](int i) {
    return static_cast<std::uint16_t>(bytes[i] << 8 | select(low[slot_of[bytes[i]]], ranks[i]));
  };
  out.lower_q4 = value(0);
  out.median_q4 = value(1);
  out.upper_q4 = value(2);
  return out;
}

}  // namespace duo::simd
