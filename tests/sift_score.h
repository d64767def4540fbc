// Our SIFT held against OpenCV's on two views of one thing, by what both are for: finding the same points and telling them
// apart.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/features2d.hpp>
#include <optional>

#include "stages/match_points/match_points.h"
#include "stages/sift/sift.h"
#include "tests/agree.h"

namespace duo::test {

constexpr int kSiftCapacity = 20000;

inline SiftPoints sift_ours(View<const std::uint8_t> picture) {
  Pool alone(1);
  SiftScratch scratch(picture.size(), kSiftCapacity);
  SiftPoints points(kSiftCapacity);
  simd::sift(alone, picture, Window::all(picture.size()), {}, scratch, points);
  EXPECT_EQ(points.overflow, 0);
  return points;
}

/// OpenCV always doubles the picture first; the points of that octave (-1), which we do not look for, are left out.
inline SiftPoints sift_opencv(View<const std::uint8_t> picture) {
  const cv::Mat gray(picture.height(), picture.width(), CV_8U, const_cast<std::uint8_t*>(picture.data()),
                     static_cast<std::size_t>(picture.stride()));
  std::vector<cv::KeyPoint> found;
  cv::Mat descriptors;
  cv::SIFT::create(0, 3, 0.04, 10, 1.6, CV_8U)->detectAndCompute(gray, {}, found, descriptors);
  SiftPoints points(std::max(1, static_cast<int>(found.size())));
  for (int i = 0; i < static_cast<int>(found.size()); ++i) {
    const cv::KeyPoint& p = found[static_cast<std::size_t>(i)];
    if (static_cast<signed char>(p.octave & 255) < 0) continue;
    points[points.count] = {p.pt.x, p.pt.y, p.size / 2, p.angle * 0.01745329f, p.response};
    std::copy_n(descriptors.ptr(i), SiftPoints::kDescriptor, points.descriptors.row(points.count++));
  }
  return points;
}

/// Where a point of the first view lies in the second; nothing where that is not known.
using Truth = std::function<std::optional<PredictedPlace>(float x, float y)>;

/// Counts, so that those of several views add up to a score of all.
struct SiftScore {
  double points = 0;                // the fewer of both views, those whose place is known
  double repeated = 0, sum_px = 0;  // one to one within 1.5 px and a ratio of scales of 1.5; their distances
  double matched = 0, right = 0;    // with ratio 0.8; of those, within 3 px

  double repeatability() const { return 100 * repeated / std::max(1.0, points); }
  double place_px() const { return sum_px / std::max(1.0, repeated); }
  double precision() const { return 100 * right / std::max(1.0, matched); }
  double matching() const { return 100 * right / std::max(1.0, points); }
  void add(const SiftScore& s) {
    points += s.points, repeated += s.repeated, sum_px += s.sum_px, matched += s.matched, right += s.right;
  }
};

inline SiftScore score(const SiftPoints& first, const SiftPoints& second, double grown, const Truth& truth) {
  SiftPoints known(std::max(1, first.count));
  std::vector<PredictedPlace> places;
  for (int i = 0; i < first.count; ++i)
    if (const auto place = truth(first[i].x_px, first[i].y_px)) {
      known[known.count] = first[i];
      std::copy_n(first.descriptors.row(i), SiftPoints::kDescriptor, known.descriptors.row(known.count++));
      places.push_back(*place);
    }
  const auto distance = [&](int i, int k) {
    const PredictedPlace& place = places[static_cast<std::size_t>(i)];
    return std::hypot(second[k].x_px - place.x_px, second[k].y_px - place.y_px);
  };

  struct Candidate {
    double distance;
    int i, k;
  };
  std::vector<Candidate> candidates;
  for (int i = 0; i < known.count; ++i)
    for (int k = 0; k < second.count; ++k) {
      const double d = distance(i, k), ratio = second[k].scale_px / (known[i].scale_px * grown);
      if (d <= 1.5 && ratio <= 1.5 && ratio >= 1 / 1.5) candidates.push_back({d, i, k});
    }
  std::stable_sort(candidates.begin(), candidates.end(), [](auto& a, auto& b) { return a.distance < b.distance; });
  std::vector<bool> used(static_cast<std::size_t>(known.count)), taken(static_cast<std::size_t>(second.count));
  SiftScore out;
  for (const Candidate& c : candidates) {
    const auto i = static_cast<std::size_t>(c.i), k = static_cast<std::size_t>(c.k);
    if (used[i] || taken[k]) continue;
    used[i] = taken[k] = true;
    ++out.repeated;
    out.sum_px += c.distance;
  }

  Pool alone(1);
  MatchPointsParams params;
  params.mutual = false;
  std::vector<PointMatch> matches(static_cast<std::size_t>(known.count));
  simd::match_points(alone, known, {}, second, params, matches);
  for (int i = 0; i < known.count; ++i)
    if (const int k = matches[static_cast<std::size_t>(i)].seen; k != PointMatch::kNone) {
      ++out.matched;
      out.right += distance(i, k) < 3;
    }
  out.points = std::min(known.count, second.count);
  return out;
}

struct SiftScores {
  SiftScore ours, opencv;
  void add(const SiftScores& s) { ours.add(s.ours), opencv.add(s.opencv); }
};

inline SiftScores score_both(View<const std::uint8_t> first, View<const std::uint8_t> second, double grown,
                             const Truth& truth) {
  return {score(sift_ours(first), sift_ours(second), grown, truth),
          score(sift_opencv(first), sift_opencv(second), grown, truth)};
}

/// Prints both and fails where ours is worse: precision and matching by more than 3 points, repeatability by more than 10, the
/// place by more than 0.05 px; each beyond what chance does to shares of so few points (two standard deviations of their
/// difference).
inline void expect_as_good_as_opencv(const std::string& what, const SiftScores& s) {
  const SiftScore &a = s.ours, &b = s.opencv;
  std::printf(
      "%-22s points %5.0f %5.0f  repeatability %4.1f %4.1f  place %4.2f %4.2f px  precision %4.1f %4.1f  matching %4.1f "
      "%4.1f\n",
      what.c_str(), a.points, b.points, a.repeatability(), b.repeatability(), a.place_px(), b.place_px(), a.precision(),
      b.precision(), a.matching(), b.matching());
  const auto chance = [](double percent_a, double count_a, double percent_b, double count_b) {
    const auto variance = [](double percent, double count) {
      return percent * (100 - std::min(percent, 100.0)) / std::max(1.0, count);
    };
    return 2 * std::sqrt(variance(percent_a, count_a) + variance(percent_b, count_b));
  };
  EXPECT_GE(a.points, 0.9 * b.points - 2 * std::sqrt(b.points)) << what;
  EXPECT_GE(a.repeatability(), b.repeatability() - 10 - chance(a.repeatability(), a.points, b.repeatability(), b.points))
      << what;
  EXPECT_LE(a.place_px(), b.place_px() + 0.05) << what;
  EXPECT_GE(a.precision(), b.precision() - 3 - chance(a.precision(), a.matched, b.precision(), b.matched)) << what;
  EXPECT_GE(a.matching(), b.matching() - 3 - chance(a.matching(), a.points, b.matching(), b.points)) << what;
}

/// The same without any allowance for chance, for a score over many views.
inline void expect_as_good_as_opencv_on_all(const std::string& what, const SiftScores& s) {
  expect_as_good_as_opencv(what, s);
  const SiftScore &a = s.ours, &b = s.opencv;
  EXPECT_GE(a.points, 0.9 * b.points) << what;
  EXPECT_GE(a.repeatability(), b.repeatability() - 10) << what;
  EXPECT_GE(a.precision(), b.precision() - 3) << what;
  EXPECT_GE(a.matching(), b.matching() - 3) << what;
}

}  // namespace duo::test
