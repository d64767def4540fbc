// From pair to frame: engines agree, nothing is allocated after the first frame, the synthetic room's truth is met, and wrong
// setups are refused before the first frame.

#include "duoptic/engine.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "duoptic/synthetic.h"
#include "tests/agree.h"
#include "tests/allocations.h"
#include "tests/engine_setups.h"

namespace duo {
namespace {

using test::kChoices, test::Choice, test::prepared, test::raw_setup, test::run;

TEST(Engine, RefAndSimdAgreeOnRawPictures) {
  SyntheticSetup synthetic;
  synthetic.size = {160, 120};
  const SyntheticPair scene = render_synthetic(synthetic, 2);
  for (const Choice& choice : kChoices) {
    const duo::Setup setup = raw_setup(scene, choice);
    const auto reference = prepared("ref", 1, setup);
    const std::shared_ptr<const Frame> want = run(*reference, scene.pair);
    test::each_target([&](const std::string& target) {
      for (const int threads : {1, 2}) {
        const auto simd = prepared("simd", threads, setup);
        const std::shared_ptr<const Frame> got = run(*simd, scene.pair);
        const std::string who =
            std::string(choice.matcher) + " " + choice.preset + " " + target + " threads " + std::to_string(threads);
        test::expect_same<std::uint8_t>(want->left, got->left, who + " left");
        test::expect_same<std::uint8_t>(want->right, got->right, who + " right");
        test::expect_same<std::uint16_t>(want->disparity.d_q4, got->disparity.d_q4, who + " disparity");
        test::expect_same<std::uint8_t>(want->disparity.origin, got->disparity.origin, who + " origin");
        test::expect_same<std::uint16_t>(want->depth_mm, got->depth_mm, who + " depth");
      }
    });
  }
}

// Of either picture; 9 sixteenths change nothing, and no noise does where pictures are denoised.
TEST(Engine, CodingNoiseComesWithThePair) {
  Pair pair = test::low_texture(false, 1);
  duo::Setup setup;
  setup.size = pair.left.pixels.size();
  setup.max_disparity = 16;
  const auto reference = prepared("ref", 1, setup), simd = prepared("simd", 2, setup);
  const auto made = [&](int left_q4, int right_q4) {
    pair.left.coding_noise_q4 = left_q4, pair.right.coding_noise_q4 = right_q4;
    Image<std::uint16_t> d_q4 = run(*reference, pair)->disparity.d_q4.clone();
    test::expect_same<std::uint16_t>(d_q4, run(*simd, pair)->disparity.d_q4, "simd");
    return d_q4;
  };
  const auto uncoded = made(0, 0), left = made(29, 0), right = made(0, 29);
  test::expect_same<std::uint16_t>(uncoded, made(9, 9), "fine coding");
  test::expect_same<std::uint16_t>(left, right, "either picture");
  int others = 0;
  for (int y = 0; y < setup.size.height; ++y)
    for (int x = 0; x < setup.size.width; ++x) others += uncoded.at(y, x) != left.at(y, x);
  EXPECT_GT(others, 100);
  for (const Denoise denoise : {Denoise::kMedian, Denoise::kGaussian, Denoise::kDiffusion}) {
    setup.denoise = denoise;
    ASSERT_TRUE(reference->prepare(setup));
    ASSERT_TRUE(simd->prepare(setup));
    test::expect_same<std::uint16_t>(made(0, 0), made(29, 29), "denoised");
  }
}

/// What `whole` has inside the windows, and nothing elsewhere.
template <class T>
Image<T> only_in(const std::vector<Window>& windows, const Image<T>& whole, T none) {
  Image<T> out(whole.size());
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const auto has_it = [&](const Window& window) { return window.contains(y, x); };
      out.at(y, x) = std::any_of(windows.begin(), windows.end(), has_it) ? whole.at(y, x) : none;
    }
  return out;
}

/// `got` was asked to look at the windows only, `whole` was not.
void expect_windows(const std::vector<Window>& windows, const Frame& whole, const Frame& got, const std::string& who) {
  const std::uint8_t none = 0;
  test::expect_same<std::uint16_t>(only_in(windows, whole.disparity.d_q4, Disparity::kNone), got.disparity.d_q4,
                                   who + " disparity");
  test::expect_same<std::uint8_t>(only_in(windows, whole.disparity.origin, none), got.disparity.origin, who + " origin");
  test::expect_same<std::uint16_t>(only_in(windows, whole.depth_mm, std::uint16_t{0}), got.depth_mm, who + " depth");
  test::expect_same<std::uint8_t>(only_in(windows, whole.confidence, none), got.confidence, who + " confidence");
  test::expect_same<std::uint8_t>(whole.left, got.left, who + " left");
}

// Wherever the windows lie, over borders and each other, in them is what the whole picture's frame has.
TEST(Engine, WindowsHaveTheWholePicturesValues) {
  SyntheticSetup synthetic;
  synthetic.size = {96, 256};  // higher than what a row depends on
  const SyntheticPair scene = render_synthetic(synthetic, 2);
  const std::vector<Window> sets[] = {{{30, 100, 40, 30}},
                                      {{0, 0, 20, 12}},
                                      {{75, 250, 100, 100}, {-20, 230, 30, 4}},
                                      {{10, 120, 30, 20}, {20, 110, 30, 40}, {20, 110, 0, 9}},
                                      {{0, 130, 96, 1}},
                                      {{500, 20, 30, 30}},
                                      {{-9, -9, 300, 300}}};
  for (const Choice& choice : kChoices)
    for (const bool fill : {false, true}) {
      duo::Setup setup = raw_setup(scene, choice);
      setup.fill = fill;
      setup.wants.confidence = std::string_view(choice.matcher) == "sgm";
      if (std::string_view(choice.matcher) == "sgm") setup.parameters = {{"refine", fill ? 0 : 1}};
      const std::string what = std::string(choice.matcher) + " " + choice.preset + (fill ? " filled" : "");
      const auto reference = prepared("ref", 1, setup);
      const std::shared_ptr<const Frame> whole = run(*reference, scene.pair);
      for (const int threads : {1, 2}) {
        const auto simd = prepared("simd", threads, setup);
        for (const std::vector<Window>& windows : sets) {
          simd->look_at(windows);
          expect_windows(windows, *whole, *run(*simd, scene.pair), what + " from row " + std::to_string(windows[0].y));
        }
        simd->look_at({});
        expect_windows({Window::all(whole->left.size())}, *whole, *run(*simd, scene.pair), what + ", whole again");
      }
      reference->look_at(sets[3]);
      expect_windows(sets[3], *whole, *run(*reference, scene.pair), what + " ref");
    }
}

TEST(Engine, AllocatesNothingAfterTheFirstFrame) {
  SyntheticSetup synthetic;
  synthetic.size = {160, 120};
  const SyntheticPair scene = render_synthetic(synthetic, 2);
  for (const Choice& choice : kChoices) {
    const auto engine = prepared("simd", 2, raw_setup(scene, choice));
    run(*engine, scene.pair);
    const long before = test::allocations;
    for (int i = 0; i < 3; ++i) run(*engine, scene.pair);
    EXPECT_EQ(test::allocations - before, 0) << choice.matcher << " " << choice.preset;
  }
  const long before = test::allocations;
  Image<std::uint8_t> counted({8, 8});
  EXPECT_GT(test::allocations - before, 0) << "the counter itself works";
}

// However many frames are held, each stays as it was, after its engine, too; the memory of those that were let go is used
// again.
TEST(Engine, AFrameBelongsToWhoHoldsIt) {
  SyntheticSetup synthetic;
  synthetic.size = {96, 72};
  const SyntheticPair scene = render_synthetic(synthetic, 2);
  for (const char* name : {"ref", "simd"}) {
    auto engine = prepared(name, 1, raw_setup(scene, kChoices[0]));
    const auto expect_frame = [&](const Frame& want, const Frame& got, int number) {
      const std::string who = std::string(name) + ", frame " + std::to_string(number);
      EXPECT_EQ(got.sequence, static_cast<std::uint64_t>(number)) << who;
      test::expect_same<std::uint8_t>(want.left, got.left, who + " left");
      test::expect_same<std::uint8_t>(want.right, got.right, who + " right");
      test::expect_same<std::uint16_t>(want.disparity.d_q4, got.disparity.d_q4, who + " disparity");
      test::expect_same<std::uint16_t>(want.depth_mm, got.depth_mm, who + " depth");
    };
    Pair pair;
    pair.left.pixels = scene.pair.left.pixels.clone();
    pair.right.pixels = scene.pair.right.pixels.clone();
    std::vector<std::shared_ptr<const Frame>> held;
    std::vector<std::unique_ptr<Engine>> others;  // the frames that each pair should have
    std::vector<std::shared_ptr<const Frame>> wanted;
    constexpr int kHeld = 1 + Engine::kSpareFrames + 2;  // two more than there are at first
    for (int i = 0; i < kHeld; ++i) {
      pair.sequence = static_cast<std::uint64_t>(i);
      for (int x = 0; x < 8; ++x) pair.left.pixels.at(8 * i, x) = {255, 255, 255};
      held.push_back(run(*engine, pair));
      others.push_back(prepared(name, 1, raw_setup(scene, kChoices[0])));
      wanted.push_back(run(*others.back(), pair));
    }
    for (int i = 0; i < kHeld; ++i) expect_frame(*wanted[static_cast<std::size_t>(i)], *held[static_cast<std::size_t>(i)], i);
    held.erase(held.begin(), held.begin() + 2);
    const long before = test::allocations;
    for (int i = 0; i < 9; ++i) {
      const auto frame = run(*engine, pair);
      EXPECT_EQ(std::count(held.begin(), held.end(), frame), 0);
    }
    if (std::string(name) == "simd") {
      EXPECT_EQ(test::allocations - before, 0);
    }
    engine.reset();
    for (int i = 2; i < kHeld; ++i)
      expect_frame(*wanted[static_cast<std::size_t>(i)], *held[static_cast<std::size_t>(i - 2)], i);
  }
}

struct Score {
  double bad = 0, covered = 0;
};

/// Share of pixels that both cameras see whose disparity is off by more than one pixel, holes bad; and the share with a
/// disparity.
Score score(const SyntheticPair& scene, const Disparity& disparity) {
  double seen = 0, bad = 0, known = 0;
  for (int y = 0; y < scene.disparity_px.height(); ++y)
    for (int x = 0; x < scene.disparity_px.width(); ++x) {
      if (scene.seen_by_both.at(y, x) == 0) continue;
      ++seen;
      const std::uint16_t d = disparity.d_q4.at(y, x);
      known += d != Disparity::kNone;
      bad += d == Disparity::kNone || std::abs(d / 16.0 - scene.disparity_px.at(y, x)) > 1.0;
    }
  return {bad / seen, known / seen};
}

/// The synthetic room, rectified as drawn, and the set-up for its pictures.
std::pair<SyntheticPair, duo::Setup> ideal_room() {
  SyntheticSetup synthetic;
  synthetic.ideal = true;
  duo::Setup setup;
  setup.size = synthetic.size;
  setup.max_disparity = 96;
  return {render_synthetic(synthetic, 2), setup};
}

TEST(Engine, MeetsTheTruthOfTheSyntheticRoom) {
  const auto [scene, asked] = ideal_room();
  duo::Setup setup = asked;
  Score scores[std::size(kChoices)];
  for (std::size_t i = 0; i < std::size(kChoices); ++i) {
    setup.matcher = kChoices[i].matcher;
    setup.preset = kChoices[i].preset;
    const auto engine = prepared("simd", 2, setup);
    scores[i] = score(scene, run(*engine, scene.pair)->disparity);
  }
  const auto& [sgm, paths8, pyramid, thesis] = scores;
  EXPECT_LT(sgm.bad, 0.1);
  EXPECT_GT(sgm.covered, 0.9);
  EXPECT_LT(paths8.bad, 0.12);
  EXPECT_LT(pyramid.bad, 0.15);
  EXPECT_GT(pyramid.covered, 0.9);
  EXPECT_LT(thesis.bad, 0.4);
  EXPECT_GT(thesis.bad, pyramid.bad) << "the pyramid's default preset is its better one";
  const auto wrong = [](const Score& s) { return s.bad - (1 - s.covered); };  // holes left out
  EXPECT_GT(wrong(pyramid), wrong(sgm)) << "what the default matcher says is the more true";
}

// The surer the pixels, the smaller their error: over ten groups of equal size, from doubtful to sure, in a room with webcam
// noise.
TEST(Engine, ConfidencePredictsError) {
  const auto [scene, asked] = ideal_room();
  duo::Setup setup = asked;
  setup.wants.confidence = true;
  const auto engine = prepared("simd", 2, setup);
  const std::shared_ptr<const Frame> frame = run(*engine, scene.pair);
  std::vector<std::pair<int, double>> pixels;
  for (int y = 0; y < setup.size.height; ++y)
    for (int x = 0; x < setup.size.width; ++x) {
      const std::uint16_t d = frame->disparity.d_q4.at(y, x);
      EXPECT_EQ(frame->confidence.at(y, x) == 0, d == Disparity::kNone);
      if (d != Disparity::kNone && scene.disparity_px.at(y, x) > 0)
        pixels.emplace_back(frame->confidence.at(y, x), std::abs(d / 16.0 - scene.disparity_px.at(y, x)) > 1.0);
    }
  std::stable_sort(pixels.begin(), pixels.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  double before = 1;
  for (std::size_t group = 0; group < 10; ++group) {
    double bad = 0;
    for (std::size_t i = group * pixels.size() / 10; i < (group + 1) * pixels.size() / 10; ++i) bad += pixels[i].second;
    bad /= static_cast<double>(pixels.size()) / 10;
    EXPECT_LE(bad, before) << "group " << group;
    before = bad;
  }
  setup.matcher = "pyramid";
  EXPECT_FALSE((*make_engine("simd", 1))->prepare(setup)) << "it has none";
}

// Metres, not only pixels: the raw pair through its rig gives the depth that the renderer knows at the same raw pixel.
TEST(Engine, RawDepthIsMetric) {
  SyntheticSetup synthetic;
  const SyntheticPair scene = render_synthetic(synthetic, 2);
  duo::Setup setup = raw_setup(scene, {"sgm", "default"});
  setup.max_disparity = 96;
  setup.fill = false;
  setup.denoise = Denoise::kAuto;
  const auto engine = prepared("simd", 2, setup);
  const std::shared_ptr<const Frame> frame = run(*engine, scene.pair);
  const Rectified& geometry = *engine->rectified();
  std::vector<double> errors;
  for (int y = 0; y < frame->depth_mm.height(); y += 4)
    for (int x = 0; x < frame->depth_mm.width(); x += 4) {
      if (frame->depth_mm.at(y, x) == 0) continue;
      // The point in the rig frame, turned to the raw left camera, through its lens to a raw pixel.
      const double z = frame->depth_mm.at(y, x) / 1000.0;
      const Vec3 in_rig = {(x - geometry.cx_px) * z / geometry.focal_px, (y - geometry.cy_px) * z / geometry.focal_px, z};
      const Vec3 p = transposed(geometry.rig_from_left) * in_rig;
      const Camera& camera = scene.rig.left;
      const double u = p.x / p.z, v = p.y / p.z, r2 = u * u + v * v;
      const auto& k = camera.distortion;
      const double radial = (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
      const double px = camera.fx_px * (u * radial + 2 * k[2] * u * v + k[3] * (r2 + 2 * u * u)) + camera.cx_px;
      const double py = camera.fy_px * (v * radial + k[2] * (r2 + 2 * v * v) + 2 * k[3] * u * v) + camera.cy_px;
      const int xi = static_cast<int>(std::lround(px)), yi = static_cast<int>(std::lround(py));
      if (xi < 0 || yi < 0 || xi >= synthetic.size.width || yi >= synthetic.size.height) continue;
      errors.push_back(std::abs(p.z - scene.depth_left_m.at(yi, xi)) / p.z);
    }
  ASSERT_GT(errors.size(), 5000U);
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.01) << "median relative depth error";
}

void expect_refused(const Setup& setup, const std::string& word) {
  auto engine = make_engine("simd", 1);
  const auto result = (*engine)->prepare(setup);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().what.find(word), std::string::npos) << result.error().what;
}

TEST(Engine, RefusesWhatCannotWork) {
  duo::Setup good;
  good.size = {64, 48};
  duo::Setup setup = good;
  setup.matcher = "guess";
  expect_refused(setup, "guess");
  setup = good;
  setup.preset = "guess";
  expect_refused(setup, "guess");
  setup = good;
  setup.max_disparity = 0;
  expect_refused(setup, "max disparity 0");
  setup.max_disparity = 1 << 20;
  expect_refused(setup, "max disparity");
  setup = good;
  setup.parameters = {{"levels", 99}};
  expect_refused(setup, "levels");
  setup = good;
  setup.wants.depth = true;
  expect_refused(setup, "needs a rig");
  setup = good;
  setup.rig = synthetic_rig({});
  expect_refused(setup, "640x480");
  setup = good;
  setup.size = {};
  expect_refused(setup, "no pixels");
  EXPECT_FALSE(make_engine("guess", 1));
  EXPECT_FALSE(make_engine("simd", 0));
}

TEST(Engine, SmallestPictures) {
  for (const Size size : {Size{1, 1}, {2, 1}, {1, 9}, {7, 3}}) {
    duo::Setup setup;
    setup.size = size;
    setup.fill = true;
    Pair pair;
    pair.left.pixels = Image<Rgb8>(size);
    pair.right.pixels = Image<Rgb8>(size);
    const auto engine = prepared("simd", 2, setup);
    EXPECT_EQ(run(*engine, pair)->disparity.d_q4.size(), size);
  }
}

}  // namespace
}  // namespace duo
