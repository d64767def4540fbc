// Depth of people at distances that a laser measured. The pairs come rectified, but their right pictures were undistorted as
// another lens; what rows tell of that is put right first, as `duoptic depth` does (docs/rows.md). Nothing says what their
// focal length times baseline is: for each folder it is taken from all the others, as the median of distance times disparity.
// Torsos are marked by hand, or are those of the people that the networks find.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "duoptic/detector.h"
#include "duoptic/engine.h"
#include "duoptic/source.h"
#include "tests/data.h"
#include "trackers/body/lift.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

/// A torso in all pictures of a folder, marked by hand: shares of the picture's width and height.
struct Torso {
  const char* folder;
  double distance_m, left, right, top, bottom;
};
constexpr Torso kTorsos[] = {
    {"dist_cm_160", 1.60, 0.53, 0.59, 0.25, 0.52},       {"dist_cm_240", 2.40, 0.535, 0.585, 0.30, 0.48},
    {"dist_cm_150_350", 1.50, 0.70, 0.82, 0.22, 0.52},   {"dist_cm_150_350", 3.50, 0.49, 0.55, 0.36, 0.50},
    {"dist_cm_176", 1.76, 0.52, 0.61, 0.25, 0.54},       {"dist_cm_176_504", 1.76, 0.34, 0.43, 0.25, 0.55},
    {"dist_cm_176_504", 5.04, 0.603, 0.622, 0.40, 0.49}, {"dist_cm_204_722", 2.04, 0.37, 0.48, 0.26, 0.53},
    {"dist_cm_204_722", 7.22, 0.59, 0.615, 0.425, 0.49}, {"dist_cm_250_350", 2.50, 0.66, 0.75, 0.30, 0.51},
    {"dist_cm_250_350", 3.50, 0.49, 0.545, 0.37, 0.50},  {"dist_cm_298_604", 2.98, 0.47, 0.55, 0.33, 0.49},
    {"dist_cm_298_604", 6.04, 0.585, 0.612, 0.41, 0.50}, {"dist_cm_790", 7.90, 0.515, 0.535, 0.50, 0.56}};

constexpr const char* kMatchers[] = {"sgm", "pyramid"};
/// The default matcher; all in a long run.
std::span<const char* const> matchers() { return std::span(kMatchers).first(test::long_run() ? 2 : 1); }

struct Sample {
  const Torso* torso;
  double d_px;
};

/// Median disparity of a torso, pixels.
double torso_px(const Image<std::uint16_t>& d_q4, const Torso& torso) {
  const auto at = [](double share, int length) { return static_cast<int>(share * length); };
  std::vector<int> known;
  for (int y = at(torso.top, d_q4.height()); y < at(torso.bottom, d_q4.height()); ++y)
    for (int x = at(torso.left, d_q4.width()); x < at(torso.right, d_q4.width()); ++x)
      if (d_q4.at(y, x) != Disparity::kNone) known.push_back(d_q4.at(y, x));
  EXPECT_GT(known.size(), 100U) << torso.folder;
  if (known.empty()) return 0;
  const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
  std::nth_element(known.begin(), middle, known.end());
  return *middle / 16.0;
}

/// Median disparity of the person whose torso's centre lies in a marked torso; none where nobody is found there.
std::optional<double> found_torso_px(const Frame& frame, std::span<const SeenPerson> people, const Torso& torso) {
  Rectified one;  // focal length times baseline: z is one over disparity
  static_cast<Pinhole&>(one) = {1, 0, 0, 1};
  const double width = frame.disparity.d_q4.width(), height = frame.disparity.d_q4.height();
  for (const SeenPerson& person : people) {
    std::array<Vec2, 4> corners;
    Vec2 centre;
    using enum BodyPoint;
    for (std::size_t i = 0; i < 4; ++i) {
      const SeenPoint& point = person.body.at(std::array{kLeftShoulder, kRightShoulder, kLeftHip, kRightHip}[i]);
      corners[i] = {point.x_px(), point.y_px()};
      centre = {centre.x + corners[i].x / (4 * width), centre.y + corners[i].y / (4 * height)};
    }
    if (centre.x < torso.left || centre.x > torso.right || centre.y < torso.top || centre.y > torso.bottom) continue;
    const double z = body::trunk_depth({frame.disparity.d_q4, &one}, corners, {0.001, 1});
    if (z > 0) return 1 / z;
  }
  return std::nullopt;
}

struct Samples {
  std::map<std::string, std::vector<Sample>> marked;  // by matcher
  std::vector<Sample> found;                          // people, by the default matcher
};

/// Of all torsos in a pair of a folder.
void sample(const Pair& pair, const RowOffsets& rows, const std::string& folder, const char* matcher,
            std::span<const SeenPerson> people, Samples& out) {
  duo::Setup setup;
  setup.size = pair.left.pixels.size();
  setup.rows = rows;
  setup.matcher = matcher;
  setup.max_disparity = 128;
  const auto engine = std::move(*make_engine("simd", 1));
  ASSERT_TRUE(engine->prepare(setup));
  engine->submit(pair);
  const std::shared_ptr<const Frame> frame = engine->collect();
  for (const Torso& torso : kTorsos) {
    if (torso.folder != folder) continue;
    out.marked[matcher].push_back({&torso, torso_px(frame->disparity.d_q4, torso)});
    if (const auto px = found_torso_px(*frame, people, torso); px && matcher == kMatchers[0])
      out.found.push_back({&torso, *px});
  }
}

Samples sample_all(const fs::path& persons) {
  std::vector<fs::path> lefts;
  for (const auto& entry : fs::recursive_directory_iterator(persons))
    if (entry.path().filename().string().ends_with("_left.jpg") && entry.path().string().find("dist_cm") != std::string::npos)
      lefts.push_back(entry.path());
  std::sort(lefts.begin(), lefts.end());
  const auto detector = make_detector({});
  EXPECT_TRUE(detector) << (detector ? "" : detector.error().what);
  if (!detector) return {};
  PeopleFinder finder(**detector, {});
  Samples out;
  for (const fs::path& left : lefts) {
    std::string right = left.string();
    right.replace(right.rfind("_left"), 5, "_right");
    auto pairs = open_pairs(left, right);
    Pair pair;
    const auto next = pairs ? (*pairs)->next(pair) : pairs.error();
    EXPECT_TRUE(next && *next == Next::kNew) << left;
    if (!next || *next != Next::kNew) continue;
    const RowOffsets rows = find_row_offsets(pair, 1);
    EXPECT_TRUE(rows.matter() && rows.lens) << left;
    const auto people = finder.look(pair.left.pixels);
    for (const char* matcher : matchers()) sample(pair, rows, left.parent_path().filename().string(), matcher, people, out);
  }
  return out;
}

/// How far each torso is off, as a share of what is allowed: 3 % of the named distance and a step of one pixel.
std::vector<double> shares_of_allowed(const std::vector<Sample>& samples) {
  std::vector<double> out;
  for (const Sample& sample : samples) {
    std::vector<double> products;
    for (const Sample& other : samples)
      if (std::strcmp(other.torso->folder, sample.torso->folder) != 0) products.push_back(other.torso->distance_m * other.d_px);
    std::nth_element(products.begin(), products.begin() + static_cast<std::ptrdiff_t>(products.size() / 2), products.end());
    const double scale = products[products.size() / 2], named_m = sample.torso->distance_m, found_m = scale / sample.d_px;
    const double allowed_m = 0.03 * named_m + found_m / sample.d_px;
    out.push_back(std::abs(found_m - named_m) / allowed_m);
    std::printf("%.2f m: %.2f m (%.1f px, %+.1f %%, %.2f of what is allowed)\n", named_m, found_m, sample.d_px,
                100 * (found_m / named_m - 1), out.back());
  }
  return out;
}

class LabDistances : public testing::Test {
 protected:
  static fs::path persons() { return test::data_folder() / "sequences" / "persons_lab_1080p"; }
  static void SetUpTestSuite() {
    if (fs::exists(persons())) samples_ = sample_all(persons());
  }
  void SetUp() override {
    if (!fs::exists(persons())) GTEST_SKIP() << "skipped: no data";
  }
  static inline Samples samples_;
};

TEST_F(LabDistances, WithinThreePercentAndOneStep) {
  for (const char* matcher : matchers()) {
    std::printf("%s:\n", matcher);
    const auto shares = shares_of_allowed(samples_.marked[matcher]);
    EXPECT_EQ(shares.size(), 29U) << matcher;
    for (const double share : shares) EXPECT_LE(share, 1) << matcher;
  }
}

TEST_F(LabDistances, OfPeopleWhoAreFoundAsWell) {
  const auto shares = shares_of_allowed(samples_.found);
  EXPECT_GE(std::ranges::count_if(shares, [](double share) { return share <= 1; }), 28) << "of " << shares.size();
}

}  // namespace
}  // namespace duo
