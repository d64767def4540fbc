#include "trackers/body/uncover.h"

#include <algorithm>
#include <cmath>

namespace duo::body {
namespace {

template <class T>
void copy(View<const T> from, Image<T>& to) {
  if (!(to.size() == from.size())) to = Image<T>(from.size());
  for (int y = 0; y < from.height(); ++y) std::copy_n(from.row(y), from.width(), to.row(y));
}

/// The colour of a place between two, `share` of the way from the first.
Rgb8 between(Rgb8 a, Rgb8 b, int step, int steps) {
  const auto mix = [&](int p, int q) { return static_cast<std::uint8_t>(p + (q - p) * step / steps); };
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

}  // namespace

void Uncover::begin(const FrameView& frame, double trunk_z_m) {
  frame_ = frame;
  trunk_z_m_ = trunk_z_m;
  copy(frame.picture, picture_);
  copy(frame.depth.d_q4, d_q4_);
  if (!(covered_.size() == d_q4_.size())) {
    covered_ = Image<std::uint8_t>(d_q4_.size());
    taken_ = Image<std::uint8_t>(d_q4_.size());
    nearer_ = Image<std::uint8_t>(d_q4_.size());
  }
  for (int y = 0; y < covered_.height(); ++y) {
    std::fill_n(covered_.row(y), covered_.width(), std::uint8_t{0});
    std::fill_n(taken_.row(y), taken_.width(), std::uint8_t{0});
  }
}

void Uncover::take_out_before(const Window& box_px, double z_m) {
  constexpr double kEdge_m = 0.03;
  const Window box = box_px.within(d_q4_.size());
  if (box.empty()) return;
  const int reach = std::max(static_cast<int>(kEdge_m * frame_.depth.px_per_m(z_m)), 1);
  // How far each pixel is from one that is nearer, along its row, and no farther than `reach`.
  for (int y = box.y; y < box.y_end(); ++y) {
    const std::uint16_t* d_q4 = frame_.depth.d_q4.row(y);
    std::uint8_t* nearer = nearer_.row(y);
    const auto is_nearer = [&](int x) {
      return d_q4[x] != Disparity::kNone && d_q4[x] != 0 && frame_.depth.z_m(d_q4[x]) < z_m;
    };
    int last = -2 * reach, ahead = box.x;
    for (int x = box.x; x < box.x_end(); ++x) {
      for (; ahead < box.x_end() && ahead <= x + reach; ++ahead)
        if (is_nearer(ahead)) last = ahead;
      nearer[x] = last >= x - reach ? 1 : 0;
    }
  }
  for (int y = box.y; y < box.y_end(); ++y) {
    std::uint8_t *covered = covered_.row(y), *taken = taken_.row(y);
    for (int from = std::max(y - reach, box.y); from <= std::min(y + reach, box.y_end() - 1); ++from) {
      const std::uint8_t* nearer = nearer_.row(from);
      for (int x = box.x; x < box.x_end(); ++x) covered[x] |= nearer[x], taken[x] |= nearer[x];
    }
  }
}

void Uncover::take_out_behind(const Window& box_px, double z_m) {
  const Window box = box_px.within(d_q4_.size());
  for (int y = box.y; y < box.y_end(); ++y)
    for (int x = box.x; x < box.x_end(); ++x) {
      const std::uint16_t q4 = frame_.depth.d_q4.at(y, x);
      if (q4 != Disparity::kNone && (q4 == 0 || frame_.depth.z_m(q4) > z_m)) taken_.at(y, x) = 1;
    }
}

void Uncover::finish() {
  constexpr double kThick_m = 0.3;
  const int width = taken_.width();
  for (int y = 0; y < taken_.height(); ++y) {
    const std::uint8_t *covered = covered_.row(y), *taken = taken_.row(y);
    Rgb8* colors = picture_.row(y);
    std::uint16_t* d_q4 = d_q4_.row(y);
    const auto is_own = [&](int x) {
      return x >= 0 && x < width && d_q4[x] != Disparity::kNone && d_q4[x] != 0 &&
             std::abs(frame_.depth.z_m(d_q4[x]) - trunk_z_m_) < kThick_m;
    };
    for (int x = 0; x < width; ++x) {
      if (taken[x] == 0) continue;
      const bool own_left = is_own(x - 1);
      int end = x;
      for (; end < width && taken[end] != 0; ++end)
        if (covered[end] != 0) d_q4[end] = Disparity::kNone;
      const bool own_right = is_own(end);
      Rgb8 right = end < width ? colors[end] : x > 0 ? colors[x - 1] : Rgb8{};
      Rgb8 left = x > 0 ? colors[x - 1] : right;
      if (own_left && !own_right && end < width) left = right;
      if (own_right && !own_left && x > 0) right = left;
      for (int i = x; i < end; ++i) colors[i] = between(left, right, i - x + 1, end - x + 1);
      x = end;
    }
  }
  frame_.picture = picture_;
  frame_.depth.d_q4 = d_q4_;
  frame_.covered = covered_;
}

}  // namespace duo::body
