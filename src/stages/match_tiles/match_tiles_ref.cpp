#include <algorithm>
#include <cstdlib>
#include <limits>

#include "core/check.h"
#include "stages/match_tiles/match_tiles.h"

namespace duo::ref {
namespace {

constexpr int kNone = std::numeric_limits<int>::max();

template <class T>
T edge(const Image<T>& image, int y, int x) {
  return image.at(std::clamp(y, 0, image.height() - 1), std::clamp(x, 0, image.width() - 1));
}

/// One channel of a picture; low = high = value where there is no interval.
struct Channel {
  Image<int> low, high;
};
struct Channels {
  Channel gray, sobel_x, sobel_y;
  Image<std::uint8_t> outside;
};

Image<int> sobel(View<const std::uint8_t> src, bool vertical, int clip) {
  Image<int> out(src.size());
  const auto at = [&](int y, int x) {
    return int{src.at(std::clamp(y, 0, src.height() - 1), std::clamp(x, 0, src.width() - 1))};
  };
  for (int y = 0; y < src.height(); ++y)
    for (int x = 0; x < src.width(); ++x) {
      const int across = at(y - 1, x + 1) + 2 * at(y, x + 1) + at(y + 1, x + 1) - at(y - 1, x - 1) - 2 * at(y, x - 1) - at(y + 1, x - 1);
      const int down = at(y + 1, x - 1) + 2 * at(y + 1, x) + at(y + 1, x + 1) - at(y - 1, x - 1) - 2 * at(y - 1, x) - at(y - 1, x + 1);
      out.at(y, x) = std::clamp(vertical ? down : across, -clip, clip) + 128;
    }
  return out;
}

/// The interval of each value and the half-way values towards its neighbours.
Channel interval(const Image<int>& value, bool horizontal, bool vertical) {
  Channel out{value.clone(), value.clone()};
  const auto widen = [&](int y, int x, int neighbour) {
    const int half = (value.at(y, x) + neighbour + 1) / 2;
    out.low.at(y, x) = std::min(out.low.at(y, x), half);
    out.high.at(y, x) = std::max(out.high.at(y, x), half);
  };
  for (int y = 0; y < value.height(); ++y)
    for (int x = 0; x < value.width(); ++x) {
      if (horizontal) widen(y, x, edge(value, y, x - 1)), widen(y, x, edge(value, y, x + 1));
      if (vertical) widen(y, x, edge(value, y - 1, x)), widen(y, x, edge(value, y + 1, x));
    }
  return out;
}

Channels channels_of(View<const std::uint8_t> picture, View<const std::uint8_t> inside, bool right, int clip) {
  Channels out;
  Image<int> half(picture.size());
  out.outside = Image<std::uint8_t>(picture.size());
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      half.at(y, x) = picture.at(y, x) >> 1;
      if (inside.empty()) continue;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          if (inside.at(std::clamp(y + dy, 0, inside.height() - 1), std::clamp(x + dx, 0, inside.width() - 1)) == 0) out.outside.at(y, x) = 1;
    }
  out.gray = interval(half, false, false);
  out.sobel_x = interval(sobel(picture, false, clip), right, false);
  out.sobel_y = interval(sobel(picture, true, clip), right, right);
  return out;
}

int difference(const Channel& left, const Channel& right, int y, int xl, int xr) {
  const int value = edge(left.low, y, xl);
  return std::max({0, value - edge(right.high, y, xr), edge(right.low, y, xr) - value});
}

/// Aggregated costs of one disparity over the whole picture.
class Costs {
 public:
  Costs(const GrayPair& pair, const MatchTilesParams& params)
      : params_(params),
        left_(channels_of(pair.left, pair.left_inside, false, params.sobel_clip)),
        right_(channels_of(pair.right, pair.right_inside, true, params.sobel_clip)),
        pixel_({pair.size().width + 6, pair.size().height + 6}),
        rows_({pair.size().width, pair.size().height + 6}),
        window_(pair.size()) {}

  void of(int d, Image<int>& best_window) {
    const int w = window_.width(), h = window_.height();
    for (int y = 0; y < h + 6; ++y)
      for (int x = 0; x < w + 6; ++x) pixel_.at(y, x) = pixel_cost(y - 3, x - 3, d);
    for (int y = 0; y < h + 6; ++y)
      for (int x = 0; x < w; ++x) {
        rows_.at(y, x) = 0;
        for (int i = 0; i < 7; ++i) rows_.at(y, x) += pixel_.at(y, x + i);
      }
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        window_.at(y, x) = 0;
        for (int i = 0; i < 7; ++i) window_.at(y, x) += rows_.at(y + i, x);
      }
    const int reach = params_.wide_shifts ? 3 : 2;
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        int least = kNone;
        for (int yy = y - 2; yy <= y + 2; yy += 2)
          for (int xx = x - reach; xx <= x + reach; xx += 2)
            if (yy >= 0 && yy < h && xx >= 0 && xx < w) least = std::min(least, window_.at(yy, xx));
        best_window.at(y, x) = least;
      }
  }

 private:
  int pixel_cost(int y, int x, int d) const {
    const int most = params_.truncation;
    if (edge(left_.outside, y, x) != 0 || edge(right_.outside, y, x - d) != 0) return 3 * most;
    return std::min(difference(left_.gray, right_.gray, y, x, x - d), most) +
           std::min(difference(left_.sobel_x, right_.sobel_x, y, x, x - d), most) +
           std::min(difference(left_.sobel_y, right_.sobel_y, y, x, x - d), most);
  }

  MatchTilesParams params_;
  Channels left_, right_;
  Image<int> pixel_, rows_, window_;
};

/// Offset in 1/16 px of the tip of a V through three costs.
int sub_pixel(int before, int best, int after) {
  if (before == kNone || after == kNone) return 0;
  const int height = std::max(before, after) - best;
  if (height == 0) return 0;
  const int n = std::abs(8 * (before - after));
  const int offset = (n + height / 2) / height;
  return before >= after ? offset : -offset;
}

}  // namespace

void match_tiles(const GrayPair& pair, const TileSets& sets, const MatchTilesParams& params, const TileMatch& out) {
  const Size size = pair.size();
  DUO_CHECK(sets.tiles == TileSets::tiles_of(size) && out.left.size() == size && out.right.size() == size && out.fine.size() == size);
  Costs costs(pair, params);
  Image<int> now(size), last(size), best(size), right_best(size), before(size), after(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      best.at(y, x) = right_best.at(y, x) = kNone;
      out.left.at(y, x) = out.right.at(y, x) = -1;
    }
  for (int d = 0; d < std::min(sets.max_disparity, size.width); ++d) {
    bool wanted = false;
    for (int t = 0; t < sets.words.height(); ++t) wanted |= TileSets::has(sets.words.row(t), d);
    if (!wanted) continue;
    now.swap(last);
    costs.of(d, now);
    for (int y = 0; y < size.height; ++y)
      for (int x = d; x < size.width; ++x) {
        const std::uint64_t* set = sets.of(y / TileSets::kHeight, x / TileSets::kWidth);
        if (!TileSets::has(set, d)) continue;
        const int cost = now.at(y, x);
        if (out.left.at(y, x) == d - 1) after.at(y, x) = cost;
        if (cost < best.at(y, x)) {
          best.at(y, x) = cost;
          out.left.at(y, x) = static_cast<std::int16_t>(d);
          before.at(y, x) = d > 0 && TileSets::has(set, d - 1) ? last.at(y, x) : kNone;
          after.at(y, x) = kNone;
        }
        if (cost < right_best.at(y, x - d)) {
          right_best.at(y, x - d) = cost;
          out.right.at(y, x - d) = static_cast<std::int16_t>(d);
        }
      }
  }
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const int d = out.left.at(y, x);
      const int offset = d < 0 ? 0 : sub_pixel(before.at(y, x), best.at(y, x), after.at(y, x));
      out.fine.at(y, x) = d < 0 ? Disparity::kNone : static_cast<std::uint16_t>(16 * d + offset);
    }
}

}  // namespace duo::ref
