#include "sources/two_views.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace duo {
namespace {

constexpr int kColumns = 160, kPatch = 11, kPatchPixels = kPatch * kPatch;

/// Brightness of a picture, each pixel the mean of a cell.
Image<float> shrunk(View<const Rgb8> picture) {
  const int step = std::max(1, (picture.width() + kColumns / 2) / kColumns);
  Image<float> out({picture.width() / step, picture.height() / step});
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      int sum = 0;
      for (int v = 0; v < step; ++v)
        for (int u = 0; u < step; ++u) {
          const Rgb8 p = picture.row(y * step + v)[x * step + u];
          sum += p.r + 2 * p.g + p.b;
        }
      out.at(y, x) = static_cast<float>(sum) / static_cast<float>(4 * step * step);
    }
  return out;
}

/// A patch without its mean, of length 1; false where it has too little contrast.
bool take_patch(const Image<float>& from, int x, int y, float least_deviation, std::vector<float>& into) {
  float sum = 0, sum_sq = 0;
  into.clear();
  for (int v = 0; v < kPatch; ++v) into.insert(into.end(), from.row(y + v) + x, from.row(y + v) + x + kPatch);
  for (const float value : into) sum += value;
  const float mean = sum / kPatchPixels;
  for (float& value : into) value -= mean, sum_sq += value * value;
  const float length = std::sqrt(sum_sq);
  if (length < least_deviation * kPatch || length <= 0) return false;
  for (float& value : into) value /= length;
  return true;
}

struct FoundPatch {
  int x = -1, y = -1;
  float correlation = -1;
};

/// Where `in` is most like the patch, near row `y`. Zero-mean normalized cross-correlation.
FoundPatch find_patch(const Image<float>& in, int y, const std::vector<float>& patch) {
  FoundPatch best;
  const int reach = in.height() / 8;
  for (int v = std::max(0, y - reach); v <= std::min(in.height() - kPatch, y + reach); ++v)
    for (int u = 0; u + kPatch <= in.width(); ++u) {
      float sum = 0, sum_sq = 0, product = 0;
      for (int row = 0; row < kPatch; ++row) {
        const float *p = in.row(v + row) + u, *q = patch.data() + row * kPatch;
        for (int column = 0; column < kPatch; ++column) {
          sum += p[column];
          sum_sq += p[column] * p[column];
          product += p[column] * q[column];
        }
      }
      const float spread = sum_sq - sum * sum / kPatchPixels;
      const float correlation = spread > kPatchPixels ? product / std::sqrt(spread) : 0;
      if (correlation > best.correlation) best = {u, v, correlation};
    }
  return best;
}

/// How far down a place of the left picture lies in the right one, and how far to the left.
struct PlaceOff {
  int x, y, off, disparity;
};

/// Rows of two views disagree by a shift, a turn and a scale, which is a plane over the picture, and disparities are of one
/// part of the picture's width: how many lie on the best plane through three, with no disparity below that of the first.
int on_one_plane(const std::vector<PlaceOff>& offs) {
  constexpr double kNear = 1.2, kSteepest = 0.15;
  constexpr int kDisparities = kColumns / 4;
  int best = 0;
  std::vector<PlaceOff> like;
  for (const PlaceOff& p : offs) {
    like.clear();
    for (const PlaceOff& o : offs)
      if (&o != &p && o.disparity >= p.disparity && o.disparity <= p.disparity + kDisparities) like.push_back(o);
    for (std::size_t j = 0; j < like.size(); ++j)
      for (std::size_t k = j + 1; k < like.size(); ++k) {
        const PlaceOff &q = like[j], &r = like[k];
        const double ax = q.x - p.x, ay = q.y - p.y, ao = q.off - p.off, bx = r.x - p.x, by = r.y - p.y, bo = r.off - p.off;
        const double area = ax * by - ay * bx;
        if (std::abs(area) < kPatchPixels) continue;
        const double by_x = (ao * by - ay * bo) / area, by_y = (ax * bo - ao * bx) / area;
        if (std::abs(by_x) > kSteepest || std::abs(by_y) > kSteepest) continue;
        int near = 1;
        for (const PlaceOff& o : like) near += std::abs(p.off + by_x * (o.x - p.x) + by_y * (o.y - p.y) - o.off) < kNear;
        best = std::max(best, near);
      }
  }
  return best;
}

}  // namespace

SameScene show_the_same(View<const Rgb8> left, View<const Rgb8> right) {
  constexpr int kStep = 7, kMost = 60, kFewest = 12;  // patches
  constexpr float kContrast = 5, kAlike = 0.8f;
  // 36 pairs of many cameras: 0.12 of the patches and more, and 0.39 of those that came back; halves of 89 single views, half of
  // them drawn: not more than 0.12 with less than 0.28, or 0.1 with 0.5.
  constexpr double kShare = 0.1, kShareOfBack = 0.33;
  const Image<float> l = shrunk(left), r = shrunk(right);
  std::vector<std::pair<int, int>> places;
  std::vector<float> patch;
  for (int y = 0; y + kPatch <= l.height(); y += kStep)
    for (int x = 0; x + kPatch <= l.width(); x += kStep)
      if (take_patch(l, x, y, kContrast, patch)) places.emplace_back(x, y);
  if (places.size() < kFewest) return SameScene::kUnknown;
  const std::size_t every = (places.size() + kMost - 1) / kMost;
  int looked_at = 0;
  std::vector<PlaceOff> offs;  // of patches that came back to where they began
  for (std::size_t i = 0; i < places.size(); i += every, ++looked_at) {
    const auto [x, y] = places[i];
    take_patch(l, x, y, kContrast, patch);
    const FoundPatch there = find_patch(r, y, patch);
    if (there.correlation < kAlike || !take_patch(r, there.x, there.y, 0, patch)) continue;
    const FoundPatch back = find_patch(l, there.y, patch);
    if (std::abs(back.x - x) <= 1 && std::abs(back.y - y) <= 1) offs.push_back({x, y, there.y - y, x - there.x});
  }
  const int agree = on_one_plane(offs);
  const bool same = agree >= kShare * looked_at && agree >= kShareOfBack * static_cast<double>(offs.size());
  return same ? SameScene::kYes : SameScene::kNo;
}

}  // namespace duo
