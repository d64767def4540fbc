#include "calib/scene_matches.h"

#include <algorithm>
#include <array>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <span>

#include "calib/align_match.h"
#include "core/pool.h"
#include "stages/gray/gray.h"
#include "stages/match_points/match_points.h"
#include "stages/sift/sift.h"

namespace duo {
namespace {

constexpr int kPairs = 12;              // looked at in a stream
constexpr int kPatience = 20;           // times that a live source may say that nothing came; a second each at most
constexpr int kPoints = 6000;           // a picture
constexpr double kSmooth_px = 0.8;      // before patches are compared: noise, and what lies between pixels
constexpr int kRadius_px = 8;           // of a patch
constexpr int kColumns = 8, kRows = 6;  // cells of the picture
constexpr int kMostOfACell = 400;       // over all pairs

struct Candidate {
  SceneMatch match;
  int square_distance;
};

/// Finds and matches the points of one pair after the other in memory that it keeps.
class Matcher {
 public:
  Matcher(Size size, int threads)
      : pool_(threads),
        gray_(size),
        smooth_left_(size),
        smooth_right_(size),
        scratch_(size, kPoints),
        left_(kPoints),
        right_(kPoints),
        found_(kPoints) {}

  /// How many points the poorer picture has.
  int add(const Pair& pair, std::vector<Candidate>& out) {
    sift(pair.left, left_, smooth_left_);
    sift(pair.right, right_, smooth_right_);
    found_.resize(static_cast<std::size_t>(left_.count));
    simd::match_points(pool_, left_, {}, right_, {.ratio_percent = 75}, found_);
    for (int i = 0; i < left_.count; ++i) {
      const PointMatch found = found_[static_cast<std::size_t>(i)];
      if (found.seen == PointMatch::kNone) continue;
      const SiftPoint &a = left_[i], &b = right_[found.seen];
      const Vec2 at = {a.x_px, a.y_px};
      if (const auto there = align_match(smooth_left_, at, smooth_right_, {b.x_px, b.y_px}, kRadius_px))
        out.push_back({{at, *there}, found.square_distance});
    }
    return std::min(left_.count, right_.count);
  }

 private:
  void sift(const Picture& picture, SiftPoints& out, Image<float>& smooth) {
    simd::gray(pool_, picture.pixels, gray_);
    simd::sift(pool_, gray_, Window::all(gray_.size()), {.contrast = 0.02f}, scratch_, out);
    const cv::Mat from(gray_.height(), gray_.width(), CV_8U, gray_.row(0), static_cast<std::size_t>(gray_.stride()));
    cv::Mat to(smooth.height(), smooth.width(), CV_32F, smooth.row(0),
               sizeof(float) * static_cast<std::size_t>(smooth.stride()));
    from.convertTo(to, CV_32F);
    cv::GaussianBlur(to, to, {}, kSmooth_px);
  }

  Pool pool_;
  Image<std::uint8_t> gray_;
  Image<float> smooth_left_, smooth_right_;
  SiftScratch scratch_;
  SiftPoints left_, right_;
  std::vector<PointMatch> found_;
};

std::vector<SceneMatch> best_of_each_cell(std::vector<Candidate> all, Size size) {
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.square_distance < b.square_distance; });
  std::array<int, kColumns * kRows> counts{};
  std::vector<SceneMatch> out;
  for (const Candidate& c : all)
    if (++counts[static_cast<std::size_t>(cell_of(c.match.left_px, size, kColumns, kRows))] <= kMostOfACell)
      out.push_back(c.match);
  return out;
}

void note(int points, SceneMatches& scene) {
  scene.fewest_points = scene.pairs == 0 ? points : std::min(scene.fewest_points, points);
  ++scene.pairs;
}

}  // namespace

int cell_of(Vec2 at_px, Size size, int columns, int rows) {
  const int column = std::clamp(static_cast<int>(at_px.x * columns / size.width), 0, columns - 1);
  const int row = std::clamp(static_cast<int>(at_px.y * rows / size.height), 0, rows - 1);
  return row * columns + column;
}

Result<SceneMatches> match_scene(PairSource& pairs, int threads, std::int64_t farthest) {
  if (pairs.live()) farthest /= 10;
  const std::int64_t count = pairs.count() > 0 ? std::min(pairs.count(), farthest) : farthest;
  const std::int64_t step = std::max<std::int64_t>(1, (count + kPairs - 1) / kPairs);
  SceneMatches scene;
  scene.size = pairs.size();
  Matcher matcher(scene.size, threads);
  std::vector<Candidate> all;
  Pair pair;
  int empty = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    DUO_TRY_ASSIGN(Next next, pairs.next(pair));
    while (next == Next::kNothing && ++empty < kPatience) {
      DUO_TRY_ASSIGN(next, pairs.next(pair));
    }
    scene.cut = next == Next::kCut;
    if (next != Next::kNew) break;
    if (i % step != 0) continue;
    note(matcher.add(pair, all), scene);
  }
  scene.matches = best_of_each_cell(std::move(all), scene.size);
  return scene;
}

SceneMatches match_pairs(std::span<const std::shared_ptr<const Pair>> pairs, int threads) {
  SceneMatches scene;
  if (pairs.empty()) return scene;
  scene.size = pairs[0]->left.pixels.size();
  std::vector<Candidate> all;
  Matcher matcher(scene.size, threads);
  for (const auto& pair : pairs) note(matcher.add(*pair, all), scene);
  scene.matches = best_of_each_cell(std::move(all), scene.size);
  return scene;
}

SceneMatches match_pair(const Pair& pair, int threads) {
  const std::shared_ptr<const Pair> one(std::shared_ptr<void>(), &pair);
  return match_pairs({&one, 1}, threads);
}

double covered_share(const std::vector<SceneMatch>& matches, Size size) {
  std::array<bool, kColumns * kRows> seen{};
  for (const SceneMatch& match : matches) seen[static_cast<std::size_t>(cell_of(match.left_px, size, kColumns, kRows))] = true;
  return static_cast<double>(std::count(seen.begin(), seen.end(), true)) / seen.size();
}

std::string missing_parts(const std::vector<SceneMatch>& matches, Size size) {
  constexpr const char *kAcross[] = {"left", "middle", "right"}, *kDown[] = {"top", "middle", "bottom"};
  std::array<int, 3> across{}, down{};
  for (const SceneMatch& match : matches) {
    ++across[static_cast<std::size_t>(cell_of(match.left_px, size, 3, 1))];
    ++down[static_cast<std::size_t>(cell_of(match.left_px, size, 1, 3))];
  }
  const int enough = std::max(3, static_cast<int>(matches.size()) / 50);
  std::string out;
  const auto add = [&](int found, const char* part, const char* kind) {
    if (found < enough) out += (out.empty() ? "" : ", ") + std::string("the ") + part + " third " + kind;
  };
  for (std::size_t i = 0; i < 3; ++i) add(across[i], kAcross[i], "of the width");
  for (std::size_t i = 0; i < 3; ++i) add(down[i], kDown[i], "of the height");
  return out;
}

}  // namespace duo
