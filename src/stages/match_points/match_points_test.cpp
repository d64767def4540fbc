#include "stages/match_points/match_points.h"

#include "tests/sift_points.h"

namespace duo {
namespace {

/// Points whose descriptors are zero but for the first byte, at (10 i, 0).
SiftPoints points_of(std::initializer_list<int> first_bytes) {
  SiftPoints points(static_cast<int>(first_bytes.size()) + 2);
  for (const int byte : first_bytes) {
    points[points.count].x_px = 10.0f * static_cast<float>(points.count);
    points.descriptors.at(points.count++, 0) = static_cast<std::uint8_t>(byte);
  }
  return points;
}

std::vector<PointMatch> matched(const SiftPoints& stored, const SiftPoints& seen, const MatchPointsParams& params,
                                std::span<const PredictedPlace> predicted = {}) {
  std::vector<PointMatch> matches(static_cast<std::size_t>(stored.count));
  ref::match_points(stored, predicted, seen, params, matches);
  return matches;
}

// By hand, distances to 100: 8 and 10 apart is exactly 80 %, not less; 7 and 10 passes.
TEST(MatchPoints, RatioByHand) {
  EXPECT_EQ(matched(points_of({100}), points_of({108, 90}), {})[0].seen, PointMatch::kNone);
  EXPECT_EQ(matched(points_of({100}), points_of({90, 107}), {})[0], (PointMatch{1, 49}));
  EXPECT_EQ(matched(points_of({100}), points_of({30}), {})[0], (PointMatch{0, 4900}));  // nothing to compare with
  EXPECT_EQ(matched(points_of({100}), points_of({}), {})[0].seen, PointMatch::kNone);
  EXPECT_EQ(matched(points_of({100}), points_of({100, 100}), {})[0].seen, PointMatch::kNone);  // 0 is not less than 0
}

// By hand: both stored points are nearest to 50; the nearer one keeps it, the first at equal distance.
TEST(MatchPoints, MutualByHand) {
  const auto seen = points_of({50, 250});
  auto matches = matched(points_of({40, 45}), seen, {});
  EXPECT_EQ(matches[0].seen, PointMatch::kNone);
  EXPECT_EQ(matches[1].seen, 0);
  matches = matched(points_of({45, 55}), seen, {});
  EXPECT_EQ(matches[0].seen, 0);
  EXPECT_EQ(matches[1].seen, PointMatch::kNone);
  MatchPointsParams alone;
  alone.mutual = false;
  matches = matched(points_of({40, 45}), seen, alone);
  EXPECT_EQ(matches[0].seen, 0);
  EXPECT_EQ(matches[1].seen, 0);
}

// By hand: seen points lie at x = 0, 10, 20; only those within 10 px of the prediction count, the border included.
TEST(MatchPoints, PredictionByHand) {
  const auto seen = points_of({100, 101, 30});
  const PredictedPlace at_20[] = {{20, 0}}, far_away[] = {{0, 10.5f}};
  MatchPointsParams params;
  params.reach_px = 10;
  EXPECT_EQ(matched(points_of({100}), seen, params)[0].seen, 0);
  EXPECT_EQ(matched(points_of({100}), seen, params, at_20)[0], (PointMatch{1, 1}));
  EXPECT_EQ(matched(points_of({100}), seen, params, far_away)[0].seen, PointMatch::kNone);
}

TEST(MatchPoints, SimdAgrees) {
  std::mt19937 rng(7);
  Pool one(1), two(2), three(3);
  int found = 0;
  for (const int stored_count : {0, 1, 2, 33})
    for (const int seen_count : {0, 1, 17, 64})
      for (const bool gated : {false, true})
        for (const bool mutual : {false, true}) {
          const auto stored = test::random_points(stored_count, rng), seen = test::random_points(seen_count, rng);
          std::vector<PredictedPlace> predicted;
          for (int i = 0; gated && i < stored_count; ++i) predicted.push_back({stored[i].x_px, stored[i].y_px});
          MatchPointsParams params;
          params.mutual = mutual;
          params.ratio_percent = 95;
          const auto want = matched(stored, seen, params, predicted);
          for (const PointMatch& m : want) found += m.seen != PointMatch::kNone;
          test::each_target([&](const std::string& target) {
            for (Pool* pool : {&one, &two, &three}) {
              std::vector<PointMatch> got(want.size());
              simd::match_points(*pool, stored, predicted, seen, params, got);
              EXPECT_TRUE(want == got) << "match_points simd " << target << " threads " << pool->threads() << " "
                                       << stored_count << "x" << seen_count;
            }
          });
        }
  EXPECT_GT(found, 50);  // the comparison is not about nothing
}

}  // namespace
}  // namespace duo
