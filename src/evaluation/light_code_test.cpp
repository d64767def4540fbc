// Structured light, by hand: Gray code, phase, what is left out, and matches on a row.
#include "evaluation/light_code.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

#include "duoptic/evaluation.h"
#include "stages/rectify/rectify.h"
#include "tests/write_media.h"

namespace duo {
namespace {

TEST(LightCode, GrayCodeByHand) {
  // 0 1 2 3 4 5 6 7 -> 000 001 011 010 110 111 101 100
  const std::uint32_t gray[] = {0, 1, 3, 2, 6, 7, 5, 4};
  for (std::uint32_t i = 0; i < 8; ++i) {
    EXPECT_EQ(gray_of(i), gray[i]);
    EXPECT_EQ(number_of_gray(gray[i]), i);
  }
  EXPECT_EQ(gray_of(1000), 0b1000011100u);  // 1000 = 1111101000, 500 = 0111110100
  EXPECT_EQ(number_of_gray(0b1000011100u), 1000u);
}

TEST(LightCode, PatternsByHand) {
  // 40 columns in stripes of 4 px: 10, so 4 bits; 24 rows: 6, so 3 bits.
  const LightCode code{{40, 24}, 8};
  const auto patterns = light_patterns(code);
  ASSERT_EQ(patterns.size(), 1u + (2 * 4 + 8) + (2 * 3 + 8));
  EXPECT_EQ(patterns[0], LightPattern{});
  EXPECT_EQ(patterns[2], (LightPattern{LightPattern::Kind::kInverse, false, 0}));
  EXPECT_EQ(patterns[9], (LightPattern{LightPattern::Kind::kSine, false, 0}));
  EXPECT_EQ(patterns[17], (LightPattern{LightPattern::Kind::kStripes, true, 0}));
  EXPECT_EQ(describe_pattern(code, patterns[2]), "stripes 1 of 4 of columns, inverse");
  EXPECT_EQ(describe_pattern(code, patterns.back()), "sine 8 of 8 of rows");
  // Column 22 lies in stripe 5, in Gray code 0111: black, white, white, white.
  const int bits[] = {0, 255, 255, 255};
  for (int bit = 0; bit < 4; ++bit) {
    EXPECT_EQ(draw_pattern(code, patterns[static_cast<std::size_t>(1 + 2 * bit)]).at(23, 22), bits[bit]);
    EXPECT_EQ(draw_pattern(code, patterns[static_cast<std::size_t>(2 + 2 * bit)]).at(0, 22), 255 - bits[bit]);
  }
  // The sine of 8 px at the centre of pixel 0, a sixteenth of a turn: 255 (0.5 + 0.5 cos 22.5 deg) = 245.3; step 1 begins 3/8
  // of a turn later: cos(22.5 - 135 deg) = -0.383, so 78.7; half as bright 39.
  EXPECT_EQ(draw_pattern(code, patterns[9]).at(5, 0), 245);
  EXPECT_EQ(draw_pattern(code, patterns[9]).at(5, 8), 245);
  EXPECT_EQ(draw_pattern(code, patterns[10]).at(5, 0), 79);
  EXPECT_EQ(draw_pattern(code, patterns[10], 128).at(5, 0), 40);
  EXPECT_EQ(draw_pattern(code, patterns[0]).at(5, 5), 0);
  // Of rows all columns are alike.
  EXPECT_EQ(draw_pattern(code, patterns.back()).at(7, 0), draw_pattern(code, patterns.back()).at(7, 39));
  EXPECT_NE(draw_pattern(code, patterns.back()).at(7, 0), draw_pattern(code, patterns.back()).at(9, 0));
}

TEST(LightCode, RefusesWhatNoProjectorShows) {
  for (const LightCode& code : {LightCode{{8, 600}, 32}, LightCode{{800, 20000}, 32}, LightCode{{800, 600}, 31},
                                LightCode{{800, 600}, 4}, LightCode{{800, 600}, 512}})
    EXPECT_FALSE(check_light_code(code).has_value());
  EXPECT_TRUE(check_light_code({{16, 16}, 8}).has_value());
  const test::TempFolder folder;
  test::put(folder / "good.json", json_from_light_code({{1280, 720}, 48}));
  EXPECT_EQ(*load_light_code(folder / "good.json"), (LightCode{{1280, 720}, 48}));
  for (const char* bad : {"{}", "[]", "no JSON", R"({"schema": "duoptic.patterns", "screen": [800], "period_px": 32})",
                          R"({"schema": "duoptic.patterns", "screen": ["a", 600], "period_px": 32})",
                          R"({"schema": 3, "screen": [800, 600], "period_px": 32})",
                          R"({"schema": "duoptic.patterns", "screen": [800, 600], "period_px": 1e300})"}) {
    test::put(folder / "bad.json", bad);
    EXPECT_FALSE(load_light_code(folder / "bad.json").has_value()) << bad;
  }
}

/// What a pixel sees that is lit by one place of an axis: `dark` + `light` times the pattern, to the power `response`.
std::vector<std::uint16_t> samples_at(double place_px, int bits, int period_px, double dark, double light,
                                      double response = 1) {
  std::vector<std::uint16_t> out;
  const auto seen = [&](double share) {
    return static_cast<std::uint16_t>(std::lround(dark + light * std::pow(share, response)));
  };
  const auto gray = gray_of(static_cast<std::uint32_t>(place_px / (period_px / 2.0)));
  for (int bit = bits - 1; bit >= 0; --bit) {
    out.push_back(seen(gray >> bit & 1));
    out.push_back(seen(1 - (gray >> bit & 1)));
  }
  for (int step = 0; step < kPhaseSteps; ++step)
    out.push_back(seen(0.5 + 0.5 * std::cos(2 * std::numbers::pi * (place_px / period_px - 3.0 * step / 8))));
  return out;
}

TEST(LightPlace, FoundToAFractionOfAPixel) {
  for (double place = 0.3; place < 640; place += 1.37) {
    const auto got = place_on_axis(samples_at(place, 6, 32, 40, 400), 32, 640, 1);
    ASSERT_EQ(got.state, LightState::kKnown) << place;
    ASSERT_NEAR(got.place_q8 / 256.0, place, 0.03) << place;
    ASSERT_NEAR(got.amplitude, 200, 2);
  }
}

// Steps of 300 + 100 cos(90 - 135 k degrees): the cosine is 0, 0.707, -1, 0.707, 0, -0.707, 1, -0.707. A quarter of a period of
// 32 px is 8 px, and stripe 4 holds 64 .. 80 px: so the place is 72.
TEST(LightPlace, PhaseByHand) {
  // Stripe 4 in 6 bits: 000110.
  const std::vector<std::uint16_t> samples = {100, 500, 100, 500, 100, 500, 500, 100, 500, 100,
                                              100, 500, 300, 371, 200, 371, 300, 229, 400, 229};
  const auto got = place_on_axis(samples, 32, 640, 1);
  EXPECT_EQ(got.state, LightState::kKnown);
  EXPECT_NEAR(got.place_q8, 72 * 256, 8);
  EXPECT_EQ(got.amplitude, 100);
}

// Projectors and cameras answer to light as they like: a response to the power of 2.2 moves no place.
TEST(LightPlace, ResponseDoesNotMatter) {
  for (const double response : {0.45, 2.2})
    for (double place = 0.3; place < 640; place += 7.77) {
      const auto got = place_on_axis(samples_at(place, 6, 32, 40, 800, response), 32, 640, 1);
      ASSERT_EQ(got.state, LightState::kKnown) << place;
      ASSERT_NEAR(got.place_q8 / 256.0, place, 0.1) << place;
    }
}

TEST(LightPlace, LeavesOutWhatItDoesNotKnow) {
  const auto good = samples_at(200, 6, 32, 40, 400);
  // Six times the noise is asked for.
  EXPECT_EQ(place_on_axis(good, 32, 640, 33).state, LightState::kKnown);
  EXPECT_EQ(place_on_axis(good, 32, 640, 34).state, LightState::kUnlit);
  auto bad = good;
  bad[14] = kSaturated;
  EXPECT_EQ(place_on_axis(bad, 32, 640, 1).state, LightState::kSaturated);
  // Two bits in doubt; and one whose other value lies far away: 200 is in stripe 12, 001010, and 101010 is stripe 51.
  bad = good;
  bad[4] = bad[5], bad[6] = bad[7];
  EXPECT_EQ(place_on_axis(bad, 32, 640, 1).state, LightState::kUncertain);
  bad = good;
  bad[0] = bad[1];
  EXPECT_EQ(place_on_axis(bad, 32, 640, 1).state, LightState::kUncertain);
  // White and its inverse, both at the sensor's end, say nothing.
  bad = good;
  bad[0] = bad[1] = kSaturated;
  EXPECT_EQ(place_on_axis(bad, 32, 640, 1).state, LightState::kUncertain);
  // One of both may be.
  bad = good;
  bad[1] = kSaturated;
  EXPECT_EQ(place_on_axis(bad, 32, 640, 1).state, LightState::kKnown);
  // A stripe that the phase does not lie in: its bits are of 200, its sine is of 216, half a period farther.
  auto other = samples_at(216, 6, 32, 40, 400);
  std::copy(good.begin(), good.begin() + 12, other.begin());
  EXPECT_EQ(place_on_axis(other, 32, 640, 1).state, LightState::kUncertain);
  // Beyond the screen's end.
  EXPECT_EQ(place_on_axis(good, 32, 190, 1).state, LightState::kUncertain);
}

// At the border between two stripes one bit is in doubt, and whatever it says the place is right.
TEST(LightPlace, BorderBetweenStripes) {
  for (const int place : {16, 32, 208, 320, 512}) {
    auto samples = samples_at(place, 6, 32, 40, 400);
    const auto before = gray_of(static_cast<std::uint32_t>(place / 16 - 1)),
               after = gray_of(static_cast<std::uint32_t>(place / 16));
    for (int bit = 0; bit < 6; ++bit)
      if (((before ^ after) >> (5 - bit) & 1) != 0) {
        for (const int lean : {-9, 0, 9}) {
          samples[static_cast<std::size_t>(2 * bit)] = 240;
          samples[static_cast<std::size_t>(2 * bit + 1)] = static_cast<std::uint16_t>(240 + lean);
          const auto got = place_on_axis(samples, 32, 640, 1);
          ASSERT_EQ(got.state, LightState::kKnown) << place;
          ASSERT_NEAR(got.place_q8, place * 256, 8) << place;
        }
      }
  }
}

TEST(LightPlace, NoiseByHand) {
  // A pure sine has none; the third harmonic of amplitude a, a cos(3 (phase - s)), has the squares 8 a^2 / 2 over three
  // degrees of freedom.
  std::vector<std::uint16_t> steps, third;
  for (int k = 0; k < kPhaseSteps; ++k) {
    const double turned = 2 * std::numbers::pi * 3 * k / 8;
    steps.push_back(static_cast<std::uint16_t>(std::lround(400 + 200 * std::cos(1 - turned) + 50 * std::cos(2 - 2 * turned))));
    third.push_back(static_cast<std::uint16_t>(std::lround(400 + 300 * std::cos(1 - 3 * turned))));
  }
  EXPECT_LT(*noise_variance(steps), 0.5);
  EXPECT_NEAR(*noise_variance(third), 300 * 300 * 4 / 3.0, 600);
  steps[3] = kSaturated;
  EXPECT_FALSE(noise_variance(steps).has_value());
}

TEST(LightPlanes, OnOneSurfaceByHand) {
  Pool pool(1);
  ViewPlaces view{Image<std::int32_t>({10, 9}), Image<std::int32_t>({10, 9})};
  const auto slanted = [](int y, int x) { return 5000 + 400 * x + 50 * y; };
  const auto seen = [&] { return place_planes(pool, view, nullptr, {{640, 480}, 32}); };
  const auto reset = [&] {
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < 10; ++x) view.x_q8.at(y, x) = slanted(y, x), view.y_q8.at(y, x) = 300 * y + 256;
  };
  reset();
  view.x_q8.at(4, 4) += 75;  // noise: of 25 pixels a twenty-fifth, in windows that have it in their middle row and column
  const PlacePlanes noisy = seen();
  EXPECT_EQ(noisy.at.x_q8.at(4, 4), slanted(4, 4) + 3);
  EXPECT_EQ(noisy.at.x_q8.at(4, 3), slanted(4, 3) + 3);
  EXPECT_EQ(noisy.at.x_q8.at(4, 8), slanted(4, 8));
  EXPECT_EQ(noisy.at.x_q8.at(0, 9), slanted(0, 9));  // a corner's window lies beside it
  EXPECT_EQ(noisy.at.y_q8.at(3, 3), 300 * 3 + 256);
  EXPECT_EQ(noisy.step.x_q8.at(0, 9), 400);
  EXPECT_EQ(noisy.step.y_q8.at(0, 9), 0);
  // Two surfaces: up to the edge each pixel has the place and the step of its own.
  reset();
  for (int y = 0; y < 9; ++y)
    for (int x = 5; x < 10; ++x) view.x_q8.at(y, x) += 3000;
  const PlacePlanes edge = seen();
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 10; ++x) {
      EXPECT_EQ(edge.at.x_q8.at(y, x), slanted(y, x) + (x < 5 ? 0 : 3000)) << y << " " << x;
      EXPECT_EQ(edge.step.x_q8.at(y, x), 400) << y << " " << x;
    }
  // A pixel between both is of neither. Those beside it go on without it.
  view.x_q8.at(4, 4) += 1500;
  const PlacePlanes mixed = seen();
  EXPECT_EQ(mixed.at.x_q8.at(4, 4), -1);
  EXPECT_EQ(mixed.at.x_q8.at(4, 3), slanted(4, 3));
  EXPECT_EQ(mixed.at.x_q8.at(4, 5), slanted(4, 5) + 3000);
  EXPECT_EQ(mixed.at.x_q8.at(3, 4), slanted(3, 4));
}

// Rectified pixel (2, x) sees the raw picture at column x / 2 + 1.25 and row 3.5.
TEST(LightPlanes, OfRectifiedPixelsByHand) {
  Pool pool(1);
  ViewPlaces view{Image<std::int32_t>({10, 9}), Image<std::int32_t>({10, 9})};
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 10; ++x) view.x_q8.at(y, x) = 5000 + 400 * x + 50 * y, view.y_q8.at(y, x) = 300 * y + 20 * x;
  ResampleMap map{Image<std::uint32_t>({8, 3}), Image<std::uint16_t>({8, 3})};
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 8; ++x) {
      const int at_q8 = 128 * x + 320;
      map.corner.at(y, x) = static_cast<std::uint32_t>(at_q8 >> 8) << 16 | 3;
      map.fraction_q8.at(y, x) = static_cast<std::uint16_t>((at_q8 & 255) << 8 | 128);
    }
  map.corner.at(2, 0) = map.corner.at(1, 4) = map.corner.at(1, 6) = ResampleMap::kOutside;
  const PlacePlanes got = place_planes(pool, view, &map, {{640, 480}, 32});
  EXPECT_EQ(got.at.x_q8.at(2, 3), 5000 + 1100 + 175);  // column 2.75
  EXPECT_EQ(got.at.y_q8.at(2, 3), 1050 + 55);
  EXPECT_EQ(got.step.x_q8.at(2, 3), 200);
  EXPECT_EQ(got.step.y_q8.at(2, 3), 10);
  EXPECT_EQ(got.at.x_q8.at(2, 0), -1);
  EXPECT_EQ(got.step.x_q8.at(2, 1), 200);  // by the neighbour that is there
  EXPECT_EQ(got.at.x_q8.at(1, 5), -1);     // none is
}

/// Places of which each lies on the plane of its own that goes on by `step_px`.
PlacePlanes row_of(const std::vector<int>& x_px, const std::vector<int>& y_px, int step_px) {
  const Size size{static_cast<int>(x_px.size()), 1};
  const auto places = [&] { return ViewPlaces{Image<std::int32_t>(size), Image<std::int32_t>(size)}; };
  PlacePlanes out{places(), places()};
  for (int x = 0; x < size.width; ++x) {
    const auto i = static_cast<std::size_t>(x);
    out.at.x_q8.at(0, x) = x_px[i] < 0 ? -1 : 256 * x_px[i];
    out.at.y_q8.at(0, x) = x_px[i] < 0 ? -1 : 256 * y_px[i];
    out.step.x_q8.at(0, x) = 256 * step_px;
    out.step.y_q8.at(0, x) = 64;
  }
  return out;
}

TEST(LightMatch, OnARowByHand) {
  // Place 105 lies a quarter of a step behind columns 1 and 5, where the projector's row is another one.
  const PlacePlanes row = row_of({100, 104, 108, 112, 98, 104, 108}, {50, 50, 50, 50, 90, 90, 90}, 4);
  const auto at = [&](int x_px, int y_px) { return find_on_row(row, 0, 0, 7, 256 * x_px, 256 * y_px, 8 * 256); };
  ASSERT_TRUE(at(105, 50));
  EXPECT_EQ(at(105, 50)->column, 1);
  EXPECT_DOUBLE_EQ(at(105, 50)->x_px, 1.25);
  EXPECT_EQ(at(105, 50)->y_q8, 50 * 256 + 16);
  EXPECT_DOUBLE_EQ(at(105, 90)->x_px, 5.25);
  EXPECT_DOUBLE_EQ(at(107, 52)->x_px, 1.75);
  EXPECT_EQ(at(107, 52)->column, 2);
  EXPECT_FALSE(at(105, 70));  // neither row is near
  EXPECT_FALSE(at(120, 50));
  // A surface ends half a pixel, and a twentieth, behind its last pixel.
  EXPECT_DOUBLE_EQ(at(114, 50)->x_px, 3.5);
  EXPECT_FALSE(at(115, 50));
  // Steps that are too wide, and pixels without a place.
  EXPECT_FALSE(find_on_row(row_of({100}, {50}, 9), 0, 0, 1, 256 * 101, 256 * 50, 8 * 256));
  EXPECT_FALSE(find_on_row(row_of({-1}, {50}, 4), 0, 0, 1, 0, 256 * 50, 80 * 256));
  EXPECT_FALSE(find_on_row(row, 0, 2, 4, 256 * 105, 256 * 50, 8 * 256));
}

TEST(LightMatch, BothViewsMustAgree) {
  Pool pool(1);
  // Left columns 3 .. 6 see what right columns 1 .. 4 see: 2 px.
  const PlacePlanes left = row_of({-1, -1, -1, 100, 102, 104, 106}, {0, 0, 0, 50, 50, 50, 50}, 2);
  const PlacePlanes right = row_of({-1, 100, 102, 104, 106, -1, -1}, {0, 50, 50, 50, 50, 0, 0}, 2);
  const ViewMatch match = match_views(pool, left, right, {{640, 480}, 32});
  const float want[] = {0, 0, 0, 2, 2, 2, 2};
  for (int x = 0; x < 7; ++x) EXPECT_FLOAT_EQ(match.disparity_px.at(0, x), want[x]) << x;
  EXPECT_EQ(match.matched, 4);
  EXPECT_EQ(match.contradicting, 0);
  // What lies to the right of its left view is nowhere.
  EXPECT_EQ(match_views(pool, right, left, {{640, 480}, 32}).matched, 0);
  // Left columns 6 and 8 have one place; right column 4 is, by the projector's row, that of column 8.
  const PlacePlanes twice = row_of({-1, -1, -1, 100, 102, 104, 106, -1, 106}, {0, 0, 0, 50, 50, 50, 50, 0, 51}, 2);
  const PlacePlanes once = row_of({-1, 100, 102, 104, 106, -1, -1, -1, -1}, {0, 50, 50, 50, 51, 0, 0, 0, 0}, 2);
  const ViewMatch doubtful = match_views(pool, twice, once, {{640, 480}, 32});
  EXPECT_EQ(doubtful.disparity_px.at(0, 6), 0);
  EXPECT_FLOAT_EQ(doubtful.disparity_px.at(0, 8), 4);
  EXPECT_EQ(doubtful.matched, 4);
  EXPECT_EQ(doubtful.contradicting, 1);
}

// A wall 5 px away whose left third is white, and dark corners: what is too bright in one exposure is told by the other.
TEST(LightDecoder, EachPixelTakesTheExposureThatShowsIt) {
  constexpr LightCode kWall{{64, 48}, 8};
  constexpr Size kSeen = {40, 24};
  const auto patterns = light_patterns(kWall);
  const auto shown = [&](std::size_t number, double bright) {
    const auto pattern = draw_pattern(kWall, patterns[number]);
    Pair out;
    for (const bool is_left : {true, false}) {
      Image<Rgb8>& picture = (is_left ? out.left : out.right).pixels;
      picture = Image<Rgb8>(kSeen);
      for (int y = 0; y < kSeen.height; ++y)
        for (int x = 0; x < kSeen.width; ++x) {
          const int on_wall = is_left ? x : x + 5;  // as the left view has it
          const double white = on_wall < 14 ? 4 : on_wall < 32 ? 1 : 0;
          const double light = bright * white * (20 + 0.6 * pattern.at(y + 4, on_wall + 8));
          const auto level = static_cast<std::uint8_t>(std::min(std::lround(light), 255L));
          picture.at(y, x) = {level, level, level};
        }
    }
    return out;
  };
  const auto known_at = [&](const LightTruth& truth, int x) { return truth.disparity_px.at(12, x); };
  auto decoder = LightDecoder::open(kWall, {}, kSeen, 1);
  ASSERT_TRUE(decoder.has_value());
  EXPECT_FALSE(decoder->truth().has_value());
  for (std::size_t i = 0; i < patterns.size(); ++i) ASSERT_TRUE(decoder->add(shown(i, 1)).has_value());
  const auto bright = decoder->truth();
  ASSERT_TRUE(bright.has_value()) << bright.error().what;
  EXPECT_EQ(bright->left.saturated, 14 * kSeen.height);
  EXPECT_EQ(bright->left.unlit, 8 * kSeen.height);
  EXPECT_EQ(known_at(*bright, 10), 0);
  EXPECT_NEAR(known_at(*bright, 22), 5, 0.1);
  EXPECT_EQ(known_at(*bright, 36), 0);
  ASSERT_TRUE(decoder->add(shown(0, 0.25)).has_value());
  EXPECT_FALSE(decoder->truth().has_value());  // an exposure has begun
  for (std::size_t i = 1; i < patterns.size(); ++i) ASSERT_TRUE(decoder->add(shown(i, 0.25)).has_value());
  const auto both = decoder->truth();
  ASSERT_TRUE(both.has_value()) << both.error().what;
  EXPECT_EQ(both->left.saturated, 0);
  EXPECT_NEAR(known_at(*both, 10), 5, 0.1);
  EXPECT_NEAR(known_at(*both, 22), 5, 0.1);
  EXPECT_EQ(known_at(*both, 36), 0);
}

TEST(LightScene, IsReadAsItWasWritten) {
  LightTruth truth;
  truth.pair.left.pixels = Image<Rgb8>({40, 30}), truth.pair.right.pixels = Image<Rgb8>({40, 30});
  truth.disparity_px = Image<float>({40, 30});
  truth.pair.left.pixels.at(3, 4) = {9, 8, 7};
  for (int y = 0; y < 30; ++y)
    for (int x = 10; x < 40; ++x) truth.disparity_px.at(y, x) = 3.0f + static_cast<float>(x) / 32;
  const test::TempFolder folder;
  ASSERT_TRUE(write_scene(truth, folder / "desk").has_value());
  const auto scene = load_scene(folder / "desk");
  ASSERT_TRUE(scene.has_value()) << scene.error().what;
  EXPECT_EQ(scene->max_disparity, 16);
  EXPECT_EQ(scene->pair.left.pixels.at(3, 4), (Rgb8{9, 8, 7}));
  for (int x = 0; x < 40; ++x) EXPECT_FLOAT_EQ(scene->truth_px.at(5, x), truth.disparity_px.at(5, x)) << x;
  std::filesystem::create_symlink("mask_nonocc.png", folder / "desk/mask_nonocc.png");  // nobody can follow it
  EXPECT_TRUE(load_scene(folder / "desk").has_value());
}

}  // namespace
}  // namespace duo
