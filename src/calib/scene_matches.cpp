#include "calib/scene_matches.h"

#include <algorithm>
#include <array>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "calib/align_match.h"
#include "core/pool.h"
#include "stages/gray/gray.h"
#include "stages/halve/halve.h"
#include "stages/match_points/match_points.h"
#include "stages/sift/sift.h"

namespace duo {

struct SceneCandidate {
  SceneMatch match;
  int square_distance;  // of the descriptors
};

namespace {

constexpr int kPairs = 12;              // looked at in a stream
constexpr int kPatience = 20;           // times that a live source may say that nothing came; a second each at most
constexpr int kPoints = 6000;           // a picture
constexpr double kSmooth_px = 0.8;      // before patches are compared: noise, and what lies between pixels
constexpr int kRadius_px = 8;           // of a patch
constexpr int kColumns = 8, kRows = 6;  // cells of the picture
constexpr int kMostOfACell = 400;       // over all pairs
constexpr int kFewOfACell = 8;          // of one pair, in a quick search
constexpr int kQuickWidth = 480;        // of its pictures at most, px
constexpr int kSmallWidth = 240;        // pictures of fewer columns are doubled: they have too few points
constexpr int kLargeWidth = 2560;       // of more are halved: points are many, and lists of 8K take gigabytes

cv::Mat cv_view(Image<std::uint8_t>& image) {
  return {image.height(), image.width(), CV_8U, image.row(0), static_cast<std::size_t>(image.stride())};
}

/// Of the picture that points are laid over each other in.
Size gray_size(Size given) {
  if (given.width < kSmallWidth) return {2 * given.width, 2 * given.height};
  while (given.width > kLargeWidth) given = half_of(given);
  return given;
}

/// Of the picture in which points are looked for.
Size searched_size(Size gray, SceneSearch search) {
  while (search == SceneSearch::kQuick && gray.width > kQuickWidth) gray = half_of(gray);
  return gray;
}

/// Keeps the best of each cell of the picture, so that they lie all over it.
void keep_best(std::vector<SceneCandidate>& candidates, Size size, int most_of_a_cell) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const SceneCandidate& a, const SceneCandidate& b) { return a.square_distance < b.square_distance; });
  std::array<int, kColumns * kRows> counts{};
  std::erase_if(candidates, [&](const SceneCandidate& c) {
    return ++counts[static_cast<std::size_t>(cell_of(c.match.left_px, size, kColumns, kRows))] > most_of_a_cell;
  });
}

}  // namespace

struct SceneMatcher::State {
  State(Size size, int threads, SceneSearch search)
      : pool(threads),
        quick(search == SceneSearch::kQuick),
        gray(gray_size(size)),
        smooth_left(gray.size()),
        smooth_right(gray.size()),
        scratch(searched_size(gray.size(), search), kPoints),
        left(kPoints),
        right(kPoints),
        found(kPoints) {
    scene.size = size;
    if (gray.size() != size) given = Image<std::uint8_t>(size);
    if (gray.width() > size.width) px_given = 0.5;
    for (Size half = size; gray.width() < half.width; px_given *= 2)
      if ((half = half_of(half)) != gray.size()) larger.emplace_back(half);
    for (Size half = gray.size(); half != searched_size(gray.size(), search); ++halvings)
      coarse.emplace_back(half = half_of(half));
  }

  void take(const Picture& picture, Image<float>& smooth) {
    simd::gray(pool, picture.pixels, given.empty() ? gray : given);
    if (px_given < 1) cv::resize(cv_view(given), cv_view(gray), {gray.width(), gray.height()}, 0, 0, cv::INTER_LINEAR);
    if (px_given > 1) {
      const Image<std::uint8_t>* from = &given;
      for (Image<std::uint8_t>& half : larger) simd::halve(pool, *from, half), from = &half;
      simd::halve(pool, *from, gray);
    }
    cv::Mat to(smooth.height(), smooth.width(), CV_32F, smooth.row(0),
               sizeof(float) * static_cast<std::size_t>(smooth.stride()));
    cv_view(gray).convertTo(to, CV_32F);
    cv::GaussianBlur(to, to, {}, kSmooth_px);
  }
  void take(const Picture& picture, SiftPoints& out, Image<float>& smooth) {
    take(picture, smooth);
    for (int i = 0; i < halvings; ++i) simd::halve(pool, i == 0 ? gray : coarse[i - 1], coarse[i]);
    const Image<std::uint8_t>& searched = halvings > 0 ? coarse.back() : gray;
    simd::sift(pool, searched, Window::all(searched.size()), {.contrast = 0.02f}, scratch, out);
  }
  /// Those of the candidates, which lie in the gray picture, that look the same there.
  void align(const std::vector<SceneCandidate>& candidates) {
    put_slopes(smooth_right, sloped_right);
    std::vector<SceneCandidate> here;
    for (SceneCandidate c : candidates)
      if (const auto there = align_match(smooth_left, c.match.left_px, sloped_right, c.match.right_px, kRadius_px)) {
        c.match.right_px = *there;
        here.push_back(c);
        c.match = {given_place_of(c.match.left_px), given_place_of(*there)};
        all.push_back(c);
      }
    last = std::move(here);
    ++scene.pairs;
  }
  /// In the gray picture: the centre of a coarse pixel lies between those of its four.
  Vec2 place_of(const SiftPoint& point) const {
    const double factor = 1 << halvings, shift = (factor - 1) / 2;
    return {factor * point.x_px + shift, factor * point.y_px + shift};
  }

  /// In the picture that was given.
  Vec2 given_place_of(Vec2 in_gray) const {
    const double shift = (px_given - 1) / 2;
    return {px_given * in_gray.x + shift, px_given * in_gray.y + shift};
  }

  Pool pool;
  const bool quick;
  Image<std::uint8_t> gray, given;          // given: where the picture has another size
  std::vector<Image<std::uint8_t>> larger;  // between the two
  double px_given = 1;                      // per pixel of gray
  std::vector<Image<std::uint8_t>> coarse;  // each half of the one before
  int halvings = 0;
  Image<float> smooth_left, smooth_right;
  Image<SlopedPixel> sloped_right;
  SiftScratch scratch;
  SiftPoints left, right;
  std::vector<PointMatch> found;
  std::vector<SceneCandidate> all, last;  // last: of one pair, in its gray pictures
  SceneMatches scene;                     // but for the matches
};

SceneMatcher::SceneMatcher(Size size, int threads, SceneSearch search)
    : state_(std::make_unique<State>(size, threads, search)) {}
SceneMatcher::~SceneMatcher() = default;

void SceneMatcher::add(const Pair& pair) {
  State& s = *state_;
  s.take(pair.left, s.left, s.smooth_left);
  s.take(pair.right, s.right, s.smooth_right);
  s.found.resize(static_cast<std::size_t>(s.left.count));
  simd::match_points(s.pool, s.left, {}, s.right, {.ratio_percent = 75}, s.found);
  std::vector<SceneCandidate> candidates;
  for (int i = 0; i < s.left.count; ++i) {
    const PointMatch found = s.found[static_cast<std::size_t>(i)];
    if (found.seen != PointMatch::kNone)
      candidates.push_back({{s.place_of(s.left[i]), s.place_of(s.right[found.seen])}, found.square_distance});
  }
  if (s.quick) keep_best(candidates, s.gray.size(), kFewOfACell);
  const int points = std::min(s.left.count, s.right.count);
  s.scene.fewest_points = s.scene.pairs == 0 ? points : std::min(s.scene.fewest_points, points);
  s.align(candidates);
}

void SceneMatcher::add_same(const Pair& pair) {
  state_->take(pair.left, state_->smooth_left);
  state_->take(pair.right, state_->smooth_right);
  state_->align(std::vector(state_->last));
}

SceneMatches SceneMatcher::matches() const {
  SceneMatches scene = state_->scene;
  std::vector<SceneCandidate> best = state_->all;
  keep_best(best, scene.size, kMostOfACell);
  for (const SceneCandidate& c : best) scene.matches.push_back(c.match);
  return scene;
}

int cell_of(Vec2 at_px, Size size, int columns, int rows) {
  const int column = std::clamp(static_cast<int>(at_px.x * columns / size.width), 0, columns - 1);
  const int row = std::clamp(static_cast<int>(at_px.y * rows / size.height), 0, rows - 1);
  return row * columns + column;
}

Result<SceneMatches> match_scene(PairSource& pairs, int threads, std::int64_t farthest) {
  if (pairs.live()) farthest /= 10;
  const std::int64_t count = pairs.count() > 0 ? std::min(pairs.count(), farthest) : farthest;
  const std::int64_t step = std::max<std::int64_t>(1, (count + kPairs - 1) / kPairs);
  SceneMatcher matcher(pairs.size(), threads);
  bool cut = false;
  Pair pair;
  int empty = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    DUO_TRY_ASSIGN(Next next, pairs.next(pair));
    while (next == Next::kNothing && ++empty < kPatience) {
      DUO_TRY_ASSIGN(next, pairs.next(pair));
    }
    cut = next == Next::kCut;
    if (next != Next::kNew) break;
    if (i % step == 0) matcher.add(pair);
  }
  SceneMatches scene = matcher.matches();
  scene.cut = cut;
  return scene;
}

SceneMatches match_pair(const Pair& pair, int threads, SceneSearch search) {
  SceneMatcher matcher(pair.left.pixels.size(), threads, search);
  matcher.add(pair);
  return matcher.matches();
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
