// When pictures were taken, and which belong together; at the end two cameras in threads.
#include <random>

#include "sources/arrival_clock.h"
#include "sources/camera/camera.h"
#include "sources/camera/clock_model.h"
#include "sources/live/live_pairs.h"
#include "sources/pairing.h"
#include "tests/camera_desk.h"

namespace duo {
namespace {

using namespace test;  // NOLINT: the desk and its cameras

TEST(Clock, JitterAndLatenessAreSmoothed) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter_ns(-3e6, 3e6);
  ClockModel clock(1.0 / 30);
  constexpr double kTrueFrame_ns = 33'333'333 * 1.00005;  // 50 ppm slow
  double worst_ns = 0, sum_sq = 0;
  int used = 0;
  for (int n = 0; n < 2000; ++n) {
    if (n % 37 == 5) continue;  // lost
    const double late_ns = n % 20 == 7 ? 15e6 : 0;
    const double truth_ns = 5e9 + n * kTrueFrame_ns;
    const double off_ns =
        static_cast<double>(clock.capture_ns(n, std::llround(truth_ns + jitter_ns(random) + late_ns))) - truth_ns;
    if (n < 90) continue;
    worst_ns = std::max(worst_ns, std::abs(off_ns));
    sum_sq += off_ns * off_ns;
    ++used;
  }
  EXPECT_LT(worst_ns, 1e6);
  EXPECT_LT(std::sqrt(sum_sq / used), 0.4e6);
  EXPECT_NEAR(clock.rate(), 1.00005, 1.5e-4);
  EXPECT_NEAR(clock.jitter_ns(), 1.73e6, 0.3e6);
}

TEST(Clock, ANewRateAndAJumpAreFollowed) {
  ClockModel clock(1.0 / 30);
  TimeNs t_ns = 1'000'000'000, last_ns = 0;
  for (int n = 0; n < 300; ++n) {
    t_ns += n < 100 ? 33'333'333 : 66'666'666;  // a camera that exposes longer in the dark
    if (n == 200) t_ns += 33'333'333 * 5;       // and one that does not count what it lost
    const TimeNs given_ns = clock.capture_ns(n, t_ns);
    EXPECT_GT(given_ns, last_ns);
    last_ns = given_ns;
    const bool soon_after = (n >= 100 && n < 103) || (n >= 200 && n < 203);
    if (soon_after) continue;
    EXPECT_NEAR(static_cast<double>(given_ns - t_ns), 0, 1e6) << n;
  }
}

Picture taken_at(double ms, std::uint64_t n = 0) {
  Picture picture;
  picture.t_ns = std::llround(ms * 1e6);
  picture.sequence = n;
  return picture;
}

TEST(Pairs, TheNearestWithinHalfAFrameAndEachOnce) {
  Pairing pairing({1.0 / 30, 1.0 / 30});
  Pair pair;
  const auto add = [&](CameraSide side, double ms) {
    Picture picture = taken_at(ms);
    pairing.put(side, picture);
    Pairing::Step step = Pairing::Step::kAlone;
    while (step == Pairing::Step::kAlone) step = pairing.step(pair);
    return step == Pairing::Step::kPair;
  };
  const auto expect_pair = [&](double left_ms, double right_ms) {
    EXPECT_EQ(pair.left.t_ns, std::llround(left_ms * 1e6));
    EXPECT_EQ(pair.right.t_ns, std::llround(right_ms * 1e6));
  };
  EXPECT_FALSE(add(CameraSide::kLeft, 0));
  EXPECT_FALSE(add(CameraSide::kLeft, 33.3));
  EXPECT_TRUE(add(CameraSide::kRight, 23.3));  // nearer to the second
  expect_pair(33.3, 23.3);
  EXPECT_EQ(pairing.alone(CameraSide::kLeft), 1);
  EXPECT_FALSE(add(CameraSide::kRight, 56.6));
  EXPECT_TRUE(add(CameraSide::kLeft, 66.6));
  expect_pair(66.6, 56.6);
  EXPECT_FALSE(add(CameraSide::kRight, 90));
  EXPECT_TRUE(add(CameraSide::kLeft, 100));
  expect_pair(100, 90);
  EXPECT_EQ(pair.sequence, 2u);
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(add(CameraSide::kLeft, 133 + 33.3 * i));  // the right camera is away
  EXPECT_TRUE(add(CameraSide::kRight, 440));
  expect_pair(133 + 33.3 * 9, 440);
}

/// Pairs of two cameras whose pictures come in the order of their times; with how many of each side.
struct Paired {
  std::vector<double> skews_ms;
  std::int64_t left_alone, right_alone;
};
Paired pair_all(std::vector<double> lefts_ms, std::vector<double> rights_ms) {
  Pairing pairing({1.0 / 25, 1.0 / 25});  // no camera here keeps to what it says
  Paired out{};
  Pair pair;
  for (std::size_t l = 0, r = 0; l < lefts_ms.size() || r < rights_ms.size();) {
    const bool left = r == rights_ms.size() || (l < lefts_ms.size() && lefts_ms[l] <= rights_ms[r]);
    Picture picture = taken_at(left ? lefts_ms[l++] : rights_ms[r++]);
    pairing.put(left ? CameraSide::kLeft : CameraSide::kRight, picture);
    for (Pairing::Step step = Pairing::Step::kAlone; step != Pairing::Step::kMore;) {
      step = pairing.step(pair);
      if (step == Pairing::Step::kPair) out.skews_ms.push_back(static_cast<double>(pair.right.t_ns - pair.left.t_ns) * 1e-6);
    }
  }
  out.left_alone = pairing.alone(CameraSide::kLeft) + static_cast<std::int64_t>(pairing.waiting(CameraSide::kLeft));
  out.right_alone = pairing.alone(CameraSide::kRight) + static_cast<std::int64_t>(pairing.waiting(CameraSide::kRight));
  return out;
}
std::vector<double> every(double step_ms, int count, double from_ms = 0) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) times.push_back(from_ms + step_ms * i);
  return times;
}

TEST(Pairs, EveryPhaseOfTwoSlowCamerasAndOfTimesThatJitter) {
  constexpr double kFrame_ms = 1000.0 / 15;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter_ms(-2, 2);
  for (int phase = 0; phase < 67; phase += 3) {
    std::vector<double> lefts = every(kFrame_ms, 150), rights = every(kFrame_ms, 150, phase);
    for (double& t : lefts) t += jitter_ms(random);
    for (double& t : rights) t += jitter_ms(random);
    const Paired paired = pair_all(lefts, rights);
    EXPECT_GE(paired.skews_ms.size(), 143u) << phase;
    for (const double skew : paired.skews_ms) EXPECT_LT(std::abs(skew), 0.61 * kFrame_ms) << phase;
  }
}

TEST(Pairs, UnlikeRatesAndLostPictures) {
  // 30 and 20 a second: each of the slower ones, 0 or a sixtieth of a second apart.
  const Paired unlike = pair_all(every(100.0 / 3, 90), every(50, 60));
  EXPECT_EQ(unlike.skews_ms.size(), 60u);
  EXPECT_EQ(unlike.left_alone, 30);
  for (const double skew : unlike.skews_ms) EXPECT_LT(std::abs(skew), 16.8);
  // One left picture is missing, and every seventh right one: no other picture takes their places.
  std::vector<double> lefts = every(100.0 / 3, 70), rights = lefts;
  lefts.erase(lefts.begin() + 31);
  for (int i = 63; i >= 0; i -= 7) rights.erase(rights.begin() + i);
  const Paired lossy = pair_all(lefts, rights);
  EXPECT_EQ(lossy.skews_ms.size(), 59u);
  EXPECT_EQ(lossy.left_alone, 10);
  EXPECT_EQ(lossy.right_alone, 1);
  for (const double skew : lossy.skews_ms) EXPECT_EQ(skew, 0);
}

TEST(Clock, ArrivalsTellRateAndTimesOfANetworkCamera) {
  constexpr double kFrame_ms = 1000.0 / 15;
  std::mt19937 random(2);
  std::exponential_distribution<double> late_ms(1 / 3.0);
  ArrivalClock clock(0);
  double worst_ms = 0;
  for (int n = 0; n < 600; ++n) {
    if (n % 50 == 33) continue;  // lost on the way
    const double stall_ms = n % 40 == 20 ? 45 : 0;
    const double taken_ms = 1000 + kFrame_ms * n;
    const TimeNs given_ns = clock.capture_ns(std::llround((taken_ms + late_ms(random) + stall_ms) * 1e6));
    if (n > 100) worst_ms = std::max(worst_ms, std::abs(static_cast<double>(given_ns) * 1e-6 - taken_ms - 3));
  }
  EXPECT_NEAR(clock.frame_s(), 1.0 / 15, 0.003);
  EXPECT_LT(worst_ms, 3);
}

/// Two cameras in threads, on a clock ten times as fast as the machine's: whatever the threads do, a pair's pictures are the
/// two that were taken nearest, and its skew is true.
TEST(LivePairs, RightPairsWithTheirTrueSkewThroughJitterLossesAndUnplugging) {
  Desk desk;
  desk.speed = 10;
  constexpr TimeNs kSkew = 9 * kMs;
  desk.cameras[1].phase_ns = kSkew;
  for (std::size_t i = 0; i < 2; ++i) {
    desk.cameras[i].jitter_ns = [i](std::int64_t n) {
      std::mt19937 random(static_cast<unsigned>(2 * n) + static_cast<unsigned>(i));
      return std::uniform_int_distribution<std::int64_t>(-2 * kMs, 2 * kMs)(random);
    };
    desk.cameras[i].loses = [i](std::int64_t n) { return n % 31 == 3 + static_cast<std::int64_t>(i); };
  }
  auto both = open_cameras(desk.calls, "camera:0", "camera:2", kWish);
  ASSERT_TRUE(both) << both.error().what;
  const auto pairs = *make_live_pairs(std::move((*both)[0]), std::move((*both)[1]));
  EXPECT_TRUE(pairs->live());
  Pair pair;
  int given = 0, right = 0;
  const auto run_until = [&](TimeNs end_ns, bool judge) {
    while (desk.now() < end_ns) {
      const auto next = pairs->next(pair);
      ASSERT_TRUE(next) << next.error().what;
      if (*next != Next::kNew || !judge) continue;
      ++given;
      EXPECT_EQ(number_in(pair.left), number_in(pair.right));
      right += std::abs(pair.right.t_ns - pair.left.t_ns - kSkew) < 1 * kMs;
    }
  };
  run_until(3500 * kMs, false);  // the clocks of the cameras are learnt
  run_until(7000 * kMs, true);
  EXPECT_GT(given, 30);
  EXPECT_GE(right, given * 99 / 100);

  desk.plugged[1] = false;
  for (int i = 0; i < 100 && pairs->warning().find("camera:2 is away") == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_NE(pairs->warning().find("camera:2 is away since"), std::string::npos) << pairs->warning();
  while (*pairs->next(pair) == Next::kNew) {
  }  // the last one may not be taken yet
  desk.plugged[1] = true;
  const TimeNs back_ns = desk.now();
  while (*pairs->next(pair) != Next::kNew) ASSERT_LT(desk.now() - back_ns, 20'000 * kMs);  // 2 s of the machine's
  std::printf("a pair again %.2f s after the camera was plugged in\n", static_cast<double>(desk.now() - back_ns) * 1e-9);
  EXPECT_NE(pairs->warning().find("camera:2 is back since"), std::string::npos) << pairs->warning();
}

/// A thousand times: whatever is unplugged in which moment, nothing hangs, and pairs come again; the end may come while one is
/// away.
TEST(LivePairs, BothUnpluggedOverAndOver) {
  Desk desk;
  desk.speed = 100;
  auto both = open_cameras(desk.calls, "camera:0", "camera:2", kWish);
  ASSERT_TRUE(both) << both.error().what;
  const auto pairs = *make_live_pairs(std::move((*both)[0]), std::move((*both)[1]));
  Pair pair;
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    auto& plugged = desk.plugged[random() % 2];
    plugged = false;
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 1000));
    plugged = true;
    if (i % 50 != 0) continue;
    int tries = 0;
    while (*pairs->next(pair) != Next::kNew) ASSERT_LT(++tries, 20) << pairs->warning();
  }
  desk.plugged[1] = false;
}

}  // namespace
}  // namespace duo
