// A session over files: each is looked at to its end, again for another board, and says what is missing.
#include "duoptic/calibration_session.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <thread>

namespace duo {
namespace {

/// Gray pairs, a tenth of a second apart.
class GrayPairs final : public PairSource {
 public:
  static constexpr int kPairs = 3;
  Size size() const override { return {160, 120}; }
  std::int64_t count() const override { return kPairs; }
  bool still() const override { return false; }
  std::string warning() const override { return {}; }
  Result<Next> next(Pair& into) override {
    if (given_ == kPairs) return Next::kEnd;
    into.left.pixels = Image<Rgb8>(size()), into.right.pixels = Image<Rgb8>(size());
    into.left.t_ns = into.right.t_ns = TimeNs{100'000'000} * given_++;
    return Next::kNew;
  }

 private:
  int given_ = 0;
};

TEST(CalibrationSession, LooksToTheEndAndSaysWhatIsMissing) {
  std::atomic<int> opened = 0;
  const Board board{.columns = 8, .rows = 6, .square_m = 0.03};
  const auto open = [&]() -> Result<std::unique_ptr<PairSource>> {
    ++opened;
    return std::unique_ptr<PairSource>(std::make_unique<GrayPairs>());
  };
  auto session = CalibrationSession::start({"left.avi", "right.avi", open}, std::make_unique<GrayPairs>(), board);
  ASSERT_TRUE(session) << session.error().what;
  CalibrationSession& s = **session;
  EXPECT_FALSE(s.live());
  const auto wait_for_end = [&] {
    for (int i = 0; i < 10'000 && s.status().state != SessionState::kEnded; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(s.status().state, SessionState::kEnded);
    EXPECT_EQ(s.status().looked, GrayPairs::kPairs);
    EXPECT_NE(s.status().problem.find("0 of 6 views"), std::string::npos) << s.status().problem;
  };
  wait_for_end();
  EXPECT_EQ(opened, 0);
  ASSERT_NE(s.status().pair, nullptr);

  const auto refused = [&](const std::string& file) { return s.save(file).error().what; };
  EXPECT_NE(refused("").find("give its file a name"), std::string::npos);
  EXPECT_NE(refused("/").find("is there already"), std::string::npos);
  EXPECT_NE(refused("/no/rig.json").find("there is none yet"), std::string::npos);

  s.choose({.columns = 7, .rows = 5, .square_m = 0.03});
  for (int i = 0; i < 10'000 && opened == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(opened, 1);
  wait_for_end();
  EXPECT_EQ(s.board().columns, 7);
}

TEST(CalibrationSession, WithNothingToOpenAgainItSaysSo) {
  auto session = CalibrationSession::start({.left_name = "left.avi", .right_name = "right.avi", .open = {}, .on_news = {}},
                                           std::make_unique<GrayPairs>(), {.columns = 8, .rows = 6, .square_m = 0.03});
  ASSERT_TRUE(session) << session.error().what;
  (*session)->choose({.columns = 7, .rows = 5, .square_m = 0.03});
  for (int i = 0; i < 10'000 && (*session)->status().problem.find("left.avi cannot be read again") == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_NE((*session)->status().problem.find("left.avi cannot be read again"), std::string::npos);
  EXPECT_EQ((*session)->board().columns, 8);
}

}  // namespace
}  // namespace duo
