// When the rig is judged, what is done about it, and that two runs do the same.
#include "pipeline/rig_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <thread>
#include <tuple>

#include "duoptic/pipeline.h"
#include "duoptic/synthetic.h"

namespace duo {
namespace {

const SyntheticPair& watched_room() {
  static const SyntheticPair room = render_synthetic({.size = {480, 360}}, 2);
  return room;
}
/// Of before the right camera rolled.
Rig rolled_rig(double degrees = 1) {
  const double c = std::cos(degrees * M_PI / 180), s = std::sin(degrees * M_PI / 180);
  Rig rig = watched_room().rig;
  rig.right_from_left = Rigid3{Mat3{{c, -s, 0, s, c, 0, 0, 0, 1}}, {}} * rig.right_from_left;
  return rig;
}

/// The room again and again, ten pairs a second.
class TenASecond final : public PairSource {
 public:
  TenASecond(int count, const Rig& rig, bool swapped = false) : count_(count), rig_(rig), swapped_(swapped) {}
  Size size() const override { return watched_room().pair.left.pixels.size(); }
  std::int64_t count() const override { return count_; }
  bool still() const override { return count_ == 1; }
  std::optional<Rig> rig() const override { return rig_; }
  std::string warning() const override { return {}; }
  Result<Next> next(Pair& into) override {
    if (given_ == count_) return Next::kEnd;
    const Pair& pair = watched_room().pair;
    into.left.pixels = (swapped_ ? pair.right : pair.left).pixels.clone();
    into.right.pixels = (swapped_ ? pair.left : pair.right).pixels.clone();
    into.left.t_ns = into.right.t_ns = given_ * TimeNs{100'000'000};
    into.sequence = static_cast<std::uint64_t>(given_++);
    return Next::kNew;
  }

 private:
  const int count_;
  const Rig rig_;
  const bool swapped_;
  int given_ = 0;
};

Pipeline watching(std::unique_ptr<PairSource> pairs, RigCheck check) {
  auto pipeline = Pipeline::open(std::move(pairs), {.engine = "", .check = check});
  EXPECT_TRUE(pipeline);
  return std::move(*pipeline);
}

/// Numbers of calls to next(), from 0; -1: none did.
struct Told {
  int news = -1, fit = -1;  // that brought news; from which on there is a fit
};

Told told_by(Pipeline& pipeline) {
  Told told;
  std::string news;
  for (int i = 0;; ++i) {
    const auto next = pipeline.next();
    EXPECT_TRUE(next) << next.error().what;
    if (!pipeline.rig_news().empty()) {
      EXPECT_EQ(told.news, -1) << "twice";
      told.news = i;
      news = pipeline.rig_news();
    }
    if (told.fit < 0 && pipeline.rig_fit()) told.fit = i;
    if (next && *next == Next::kNew) continue;
    EXPECT_EQ(news, pipeline.rig_fit() ? pipeline.rig_fit()->what : "");
    return told;
  }
}

TEST(RigWatch, OfFilesItCountsFromTheSamePairOnInEveryRun) {
  const auto expect = [](std::unique_ptr<PairSource> pairs, int counts_at) {
    Pipeline pipeline = watching(std::move(pairs), RigCheck::kTell);
    const Told told = told_by(pipeline);
    EXPECT_EQ(told.fit, counts_at);
    EXPECT_GE(told.news, 0);
    EXPECT_LE(told.news, counts_at);  // as soon as it is known
    return *pipeline.rig_fit();
  };
  for (int run = 0; run < 2; ++run) {
    const RigFit sure = expect(std::make_unique<TenASecond>(8, rolled_rig()), 1);  // 0.1 s after the first, which is enough
    EXPECT_EQ(sure.verdict, RigVerdict::kRecalibrate);
    EXPECT_GT(sure.disparity_sigma_px, 0.5);
    const RigFit doubtful = expect(std::make_unique<TenASecond>(10, rolled_rig(0.35)), 8);  // 0.8 s after the first, by three
    EXPECT_NE(doubtful.verdict, RigVerdict::kGood);
  }
  expect(std::make_unique<TenASecond>(4, rolled_rig(0.35)), 4);  // its end
  expect(std::make_unique<TenASecond>(1, rolled_rig()), 0);
}

TEST(RigWatch, TheRightRigIsNoNews) {
  Pipeline good = watching(std::make_unique<TenASecond>(12, watched_room().rig), RigCheck::kStrict);
  EXPECT_EQ(told_by(good).news, -1);
  ASSERT_TRUE(good.rig_fit());
  EXPECT_EQ(good.rig_fit()->verdict, RigVerdict::kGood);
  Pipeline untold = watching(std::make_unique<TenASecond>(12, rolled_rig()), RigCheck::kNone);
  EXPECT_EQ(told_by(untold).news, -1);
  EXPECT_FALSE(untold.rig_fit());
}

TEST(RigWatch, LiveItIsLookedAtAgainEveryMinute) {
  RigWatch watch(watched_room().rig, true);
  const auto pair_at = [](double t_s, bool swapped) {
    auto pair = std::make_shared<Pair>();
    const Pair& room = watched_room().pair;
    pair->left.pixels = (swapped ? room.right : room.left).pixels.clone();
    pair->right.pixels = (swapped ? room.left : room.right).pixels.clone();
    pair->left.t_ns = static_cast<TimeNs>(t_s * 1e9);
    return pair;
  };
  /// A second from `t_s` on, then as long as it takes, but no minute of the source's time.
  const auto news_from = [&](double t_s, bool swapped) {
    for (int i = 0; i < 2000; ++i) {
      if (watch.see(pair_at(t_s + 0.1 * std::min(i, 10), swapped), false) != nullptr) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  };
  EXPECT_TRUE(news_from(0, false));
  EXPECT_EQ(watch.fit()->verdict, RigVerdict::kGood);
  EXPECT_TRUE(news_from(61, true));
  EXPECT_EQ(watch.fit()->verdict, RigVerdict::kRecalibrate);
}

/// What comes of judges of which the first step, or the second, throws where it is asked to; pairs of 0.1 s each.
std::optional<RigFit> fit_where_thrown(bool by_first, bool by_all) {
  static const RigFit wrong{RigVerdict::kRecalibrate, "wrong"};
  const auto judge_of = [=](Size) -> RigJudge {
    return {[=](const std::shared_ptr<const Pair>&) -> std::optional<RigFit> {
              if (by_first) throw std::bad_alloc();
              return std::nullopt;
            },
            [=](std::span<const std::shared_ptr<const Pair>> others, const PairSum*) {
              EXPECT_EQ(others.size(), 2u);
              if (by_all) throw std::bad_alloc();
              return wrong;
            },
            nullptr};
  };
  RigWatch watch(judge_of, false);
  for (int i = 0; i <= 8; ++i) {
    auto pair = std::make_shared<Pair>();
    pair->left.t_ns = i * TimeNs{100'000'000};
    watch.see(pair, false);
  }
  return watch.fit();
}

TEST(RigWatch, AWorkerThatFailsFindsNothing) {
  for (const auto& [by_first, by_all] : {std::pair(true, false), std::pair(false, true)}) {
    const auto fit = fit_where_thrown(by_first, by_all);
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->verdict, RigVerdict::kGood);
    EXPECT_EQ(fit->what, "");
  }
  const auto whole = fit_where_thrown(false, false);
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->what, "wrong");
}

TEST(RigWatch, WhoHasNoMemoryForAJudgeFindsNothing) {
  RigWatch watch([](Size) -> RigJudge { throw std::bad_alloc(); }, false);
  for (int i = 0; i <= 1; ++i) {
    auto pair = std::make_shared<Pair>();
    pair->left.t_ns = i * TimeNs{100'000'000};
    watch.see(pair, false);
  }
  ASSERT_TRUE(watch.fit());
  EXPECT_EQ(watch.fit()->what, "");
}

/// What all are judged by, of pairs that come so much after each other.
struct JudgedBy {
  std::size_t others = 0;
  int summed = -1;  // -1: there was no sum
};
JudgedBy judged_by(TimeNs between_ns, bool sums) {
  JudgedBy by;
  const auto judge_of = [&](Size size) -> RigJudge {
    return {[](const std::shared_ptr<const Pair>&) -> std::optional<RigFit> { return std::nullopt; },
            [&](std::span<const std::shared_ptr<const Pair>> others, const PairSum* sum) {
              by = {others.size(), sum != nullptr ? sum->pairs() : -1};
              return RigFit();
            },
            sums ? std::make_shared<PairSum>(size) : nullptr};
  };
  RigWatch watch(judge_of, false);
  for (int i = 0; !watch.settled(); ++i) {
    auto pair = std::make_shared<Pair>();
    pair->left.pixels = Image<Rgb8>({16, 12}), pair->right.pixels = Image<Rgb8>({16, 12});
    pair->left.t_ns = i * between_ns;
    watch.see(pair, false);
  }
  return by;
}

/// Ten a second are summed for 0.6 s; of few a second all three are looked at, unless the second comes after all counts.
TEST(RigWatch, JudgesBySumAndOthers) {
  for (const auto& [between_ms, others, summed] : {std::tuple(100, 2u, 6), std::tuple(300, 2u, 2), std::tuple(500, 2u, 2),
                                                   std::tuple(700, 2u, 1), std::tuple(900, 1u, 1)}) {
    const JudgedBy by = judged_by(between_ms * TimeNs{1'000'000}, true);
    EXPECT_EQ(by.others, others) << between_ms;
    EXPECT_EQ(by.summed, summed) << between_ms;
  }
  EXPECT_EQ(judged_by(100'000'000, false).summed, -1);
}

TEST(RigWatch, StrictEndsTheRun) {
  Pipeline swapped = watching(std::make_unique<TenASecond>(1, watched_room().rig, true), RigCheck::kStrict);
  const auto next = swapped.next();
  ASSERT_FALSE(next);
  EXPECT_EQ(next.error().code, ErrorCode::kBadInput);
  EXPECT_NE(next.error().what.find("swapped"), std::string::npos) << next.error().what;
}

/// By hand: at 2 m with a focal length of 500 px and 0.1 m between the cameras a pixel is 2 * 2 / 50 = 0.08 m along z, and half
/// of that along x where x is half of z.
TEST(RigWatch, JointsAreAsMuchLessSure) {
  Person person;
  person.skeleton = &kRightArm;
  Joint& joint = person.joints[0];
  joint.state = JointState::kSeen;
  joint.p_in_rig_m = {1, 0, 2};
  joint.cov_m2 = Covariance3::isotropic(0.01);
  Rectified rectified;
  rectified.focal_px = 500;
  rectified.baseline_m = 0.1;
  widen({&person, 1}, rectified, 1);
  EXPECT_NEAR(joint.cov_m2.zz, 0.0001 / 3 + 0.08 * 0.08, 1e-12);
  EXPECT_NEAR(joint.cov_m2.xx, 0.0001 / 3 + 0.04 * 0.04, 1e-12);
  EXPECT_NEAR(joint.cov_m2.xz, 0.04 * 0.08, 1e-12);
  EXPECT_NEAR(joint.cov_m2.yy, 0.0001 / 3, 1e-12);
}

}  // namespace
}  // namespace duo
