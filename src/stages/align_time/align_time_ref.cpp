#include "stages/align_time/align_time.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "stages/align_time/block_flow.h"

namespace duo::ref {
namespace {

constexpr TimeNs kLongestGap_ns = 150'000'000;  // between pictures: over more, paths are not straight

void copy_rows(const Image<Rgb8>& from, Image<Rgb8>& to) {
  for (int y = 0; y < from.height(); ++y) std::copy_n(from.row(y), from.width(), to.row(y));
}

/// The picture between its pixels, 1/256 px; outside it its border goes on.
Rgb8 sample_q8(const Image<Rgb8>& picture, int x_q8, int y_q8) {
  const auto at = [&](int x, int y) {
    return picture.at(std::clamp(y, 0, picture.height() - 1), std::clamp(x, 0, picture.width() - 1));
  };
  const int x = x_q8 >> 8, y = y_q8 >> 8, a = x_q8 & 255, b = y_q8 & 255;
  const Rgb8 p = at(x, y), q = at(x + 1, y), r = at(x, y + 1), s = at(x + 1, y + 1);
  const auto mix = [&](int pc, int qc, int rc, int sc) {
    return static_cast<std::uint8_t>(((pc * (256 - a) + qc * a) * (256 - b) + (rc * (256 - a) + sc * a) * b + 32768) >> 16);
  };
  return {mix(p.r, q.r, r.r, s.r), mix(p.g, q.g, r.g, s.g), mix(p.b, q.b, r.b, s.b)};
}

}  // namespace

struct AlignTime::State {
  BlockFlow flow;
  std::vector<Way> landed;  // of each cell: the way of what is there at the left picture's moment
  Image<Rgb8> last, moved;  // the right camera's picture before, and the one that is handed out
  TimeNs last_ns = 0;
  bool has_last = false, ever_skewed = false;

  void resize(Size size) {
    if (last.size() == size) return;
    flow = BlockFlow(size);
    landed.resize(static_cast<std::size_t>(flow.width()) * static_cast<std::size_t>(flow.height()));
    last = Image<Rgb8>(size);
    moved = Image<Rgb8>(size);
    has_last = false;
  }

  /// Where each moving cell was; of several in one place the fastest, which mostly is the nearest.
  void land(const std::vector<Way>& ways, int share_q8) {
    const auto size2 = [](Way w) { return w.x_q4 * w.x_q4 + w.y_q4 * w.y_q4; };
    const auto back = [&](int way_q4) { return (way_q4 * share_q8 + 2048) >> 12; };  // in whole cells
    std::fill(landed.begin(), landed.end(), Way{});
    for (int y = 0; y < flow.height(); ++y)
      for (int x = 0; x < flow.width(); ++x) {
        const Way way = ways[static_cast<std::size_t>(y * flow.width() + x)];
        if (!way.moved()) continue;
        // Neighbours whose ways differ leave gaps of a cell: each cell fills those right and below of it, too.
        for (int v = y - back(way.y_q4), k = 0; k < 4; ++k) {
          const int to_x = x - back(way.x_q4) + k % 2, to_y = v + k / 2;
          if (to_x < 0 || to_y < 0 || to_x >= flow.width() || to_y >= flow.height()) continue;
          Way& there = landed[static_cast<std::size_t>(to_y * flow.width() + to_x)];
          if (k == 0 ? size2(way) >= size2(there) : !there.moved()) there = way;
        }
      }
  }

  void paint(const Image<Rgb8>& now, const std::vector<Way>& ways, int share_q8) {
    const int step = flow.step();
    for (int y = 0; y < flow.height(); ++y)
      for (int x = 0; x < flow.width(); ++x) {
        const auto i = static_cast<std::size_t>(y * flow.width() + x);
        const Way way = landed[i];
        if (!way.moved() && !ways[i].moved()) continue;
        const int dx_q8 = way.x_q4 * share_q8 * step / 16, dy_q8 = way.y_q4 * share_q8 * step / 16;
        for (int v = y * step; v < (y + 1) * step; ++v)
          for (int u = x * step; u < (x + 1) * step; ++u)
            moved.at(v, u) = way.moved() ? sample_q8(now, u * 256 + dx_q8, v * 256 + dy_q8) : last.at(v, u);
      }
  }
};

AlignTime::AlignTime() : state_(std::make_unique<State>()) {}
AlignTime::~AlignTime() = default;

namespace {

bool is_skewed(const Pair& pair) {
  constexpr TimeNs kShortest_ns = 200'000;  // in less an arm moves by a fraction of a millimetre
  const TimeNs skew_ns = std::abs(pair.right.t_ns - pair.left.t_ns);
  return skew_ns >= kShortest_ns && skew_ns <= kLongestGap_ns;
}

}  // namespace

bool AlignTime::begins_with(const Pair& pair) const { return !state_->ever_skewed && is_skewed(pair); }

void AlignTime::begin(const Pair& before) {
  state_->ever_skewed = true;
  remember(before);
}

/// Takes the right picture in; false when its skew is none to be put right, and then the pair is kept for the next.
bool AlignTime::see(const Pair& pair) {
  const bool skewed = is_skewed(pair);
  state_->ever_skewed |= skewed;
  if (!state_->ever_skewed) return false;
  // Cameras of unlike rates are together in one pair and apart in the next, which needs the one before it.
  state_->resize(pair.right.pixels.size());
  state_->flow.see(pair.right.pixels);
  if (!skewed) keep(pair);
  return skewed;
}

/// For the next pair.
void AlignTime::keep(const Pair& pair) {
  copy_rows(pair.right.pixels, state_->last);
  state_->last_ns = pair.right.t_ns;
  state_->has_last = true;
}

void AlignTime::remember(const Pair& pair) {
  if (see(pair)) keep(pair);
}

Image<Rgb8>* AlignTime::right_of(const Pair& pair) {
  if (!see(pair)) return nullptr;
  State& s = *state_;
  const Image<Rgb8>& now = pair.right.pixels;
  const TimeNs skew_ns = pair.right.t_ns - pair.left.t_ns, since_ns = pair.right.t_ns - s.last_ns;
  const bool known = s.has_last && since_ns > 0 && since_ns <= kLongestGap_ns;
  if (known) {
    const double share = static_cast<double>(skew_ns) / static_cast<double>(since_ns);
    const auto share_q8 = static_cast<int>(std::lround(256 * std::clamp(share, -1.0, 1.0)));
    const std::vector<Way>& ways = s.flow.find();
    s.land(ways, share_q8);
    copy_rows(now, s.moved);
    s.paint(now, ways, share_q8);
  }
  keep(pair);
  return known ? &s.moved : nullptr;
}

}  // namespace duo::ref
