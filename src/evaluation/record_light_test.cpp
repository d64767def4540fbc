// Recording patterns before cameras that are late, noisy, and see the screen change in the middle of a picture.
#include <gtest/gtest.h>

#include <deque>

#include "core/clock.h"
#include "duoptic/structured_light.h"

namespace duo {
namespace {

constexpr LightCode kSmall{{64, 48}, 8};

/// Two live cameras that see the screen itself, `late` pictures after it changed.
class Desk final : public LightScreen, public PairSource {
 public:
  int late = 2, shown = 0;
  int restless_after = 1000;  // pictures of the screen
  bool seen = true, closes = false, files = false;

  Result<bool> show(View<const std::uint8_t> picture) override {
    screen_ = Image<std::uint8_t>(picture.size());
    for (int y = 0; y < picture.height(); ++y) std::copy_n(picture.row(y), picture.width(), screen_.row(y));
    ++shown;
    return !closes;
  }
  Size size() const override { return kSmall.screen; }
  std::int64_t count() const override { return 0; }
  bool still() const override { return false; }
  bool live() const override { return !files; }
  std::string warning() const override { return {}; }
  Result<Next> next(Pair& into) override {
    on_the_way_.push_back(screen_.clone());
    while (static_cast<int>(on_the_way_.size()) > late + 1) on_the_way_.pop_front();
    ++number_;
    const Image<std::uint8_t>& picture = on_the_way_.front();
    const Image<std::uint8_t>& later = on_the_way_[on_the_way_.size() > 1 ? 1 : 0];
    for (Picture* view : {&into.left, &into.right}) {
      view->pixels = Image<Rgb8>(kSmall.screen);
      view->t_ns = wall_ns();
      for (int y = 0; y < kSmall.screen.height; ++y)
        for (int x = 0; x < kSmall.screen.width; ++x) {
          // The upper half is read out later: it shows what comes next.
          const int lit = !seen ? 0 : (y < 24 ? later : picture).at(y, x) / 2;
          const int noise = static_cast<int>((x * 7 + y * 13 + number_ * 3) % 5) - 2;
          const int lamp = shown > restless_after ? 20 * static_cast<int>(number_ % 2) : 0;
          const auto level = static_cast<std::uint8_t>(60 + lit + noise + lamp);
          view->pixels.at(y, x) = {level, level, level};
        }
    }
    return Next::kNew;
  }

 private:
  Image<std::uint8_t> screen_;
  std::deque<Image<std::uint8_t>> on_the_way_;
  std::int64_t number_ = 0;
};

constexpr LightRecording kQuick{.average = 5, .white = 255, .warm_up_s = 0.01, .most_s = 2};

TEST(RecordLight, EachPatternIsTheOneThatWasShown) {
  for (const int late : {0, 1, 4}) {
    Desk desk;
    desk.late = late;
    const auto patterns = light_patterns(kSmall);
    std::size_t kept = 0;
    const auto done = record_light(desk, kSmall, kQuick, desk, [&](std::size_t number, const Pair& pair) -> Result<void> {
      EXPECT_EQ(number, kept++);
      const auto want = draw_pattern(kSmall, patterns[number]);
      for (int y = 0; y < kSmall.screen.height; ++y)
        for (int x = 0; x < kSmall.screen.width; ++x)
          EXPECT_NEAR(pair.right.pixels.at(y, x).g, 60 + want.at(y, x) / 2, 1) << late << ": pattern " << number;
      return {};
    });
    ASSERT_TRUE(done.has_value()) << done.error().what;
    EXPECT_EQ(kept, patterns.size());
    EXPECT_EQ(desk.shown, static_cast<int>(patterns.size()) + 1);
  }
}

TEST(RecordLight, SaysWhyItCannot) {
  const auto why = [](Desk& desk, double most_s = 0.05) {
    LightRecording how = kQuick;
    how.most_s = most_s;
    const auto done = record_light(desk, kSmall, how, desk, [](std::size_t, const Pair&) { return Result<void>(); });
    return done ? std::string() : done.error().what;
  };
  Desk unseen, restless, closed, files;
  unseen.seen = false;
  EXPECT_NE(why(unseen).find("pattern 0 of"), std::string::npos) << why(unseen);
  EXPECT_NE(why(unseen).find("is not seen within 0.05 s"), std::string::npos) << why(unseen);
  restless.restless_after = 3;
  EXPECT_NE(why(restless).find("do not come to rest"), std::string::npos) << why(restless);
  closed.closes = true;
  EXPECT_NE(why(closed).find("ended before all"), std::string::npos);
  files.files = true;
  EXPECT_NE(why(files).find("give two cameras"), std::string::npos);
}

}  // namespace
}  // namespace duo
