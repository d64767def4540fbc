// A player does between two frames what it is asked for: steps, seeks, plays to the end and again, writes, and says what it
// cannot.
#include "duoptic/player.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "tests/agree.h"
#include "tests/waving_clip.h"
#include "tests/write_media.h"

namespace duo {
namespace {

using namespace test;  // NOLINT: the clip of tests/waving_clip.h

class Playing : public ::testing::Test {
 protected:
  Playing() {
    PlayerSetup setup;
    setup.pipeline = pipeline_setup();
    setup.pipeline.tracker = "arm";
    setup.open = [this]() -> Result<Input> {
      ++opened_;
      return Input{std::make_unique<Clip>(), clip_rig(), {"clip"}};
    };
    auto player = Player::open(std::move(setup), std::make_unique<Clip>());
    EXPECT_TRUE(player) << player.error().what;
    player_ = std::move(*player);
    player_->set_speed(100);
  }
  template <class F>
  void wait_for(F&& reached) const {
    for (int i = 0; i < 10'000 && !reached(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_TRUE(reached());
  }
  void wait_for_frame(std::int64_t number) const {
    wait_for([&] { return player_->newest() != nullptr && player_->newest()->number == number; });
  }
  void wait_for_end() const {
    wait_for([&] { return player_->status().state == PlayState::kEnded; });
  }

  std::atomic<int> opened_ = 0;
  std::unique_ptr<Player> player_;
};

TEST_F(Playing, StepsSeeksPlaysToTheEndAndAgain) {
  EXPECT_EQ(player_->newest(), nullptr);
  EXPECT_TRUE(player_->asks_for_clicks());
  EXPECT_EQ(player_->count(), kClipPairs);
  for (const std::int64_t number : {0, 1, 2}) {
    player_->step();
    wait_for_frame(number);
  }
  EXPECT_EQ(player_->status().state, PlayState::kPaused);
  player_->seek(6);
  wait_for_frame(6);
  EXPECT_EQ(opened_, 1);
  EXPECT_EQ(player_->status().state, PlayState::kPaused);
  player_->play(true);
  wait_for_end();
  EXPECT_EQ(player_->newest()->number, kClipPairs - 1);
  player_->restart();
  wait_for([&] { return opened_ == 2 && player_->newest()->number < kClipPairs - 1; });  // it is at its end until then
  wait_for_end();
  player_->seek(3);
  wait_for_frame(3);
  EXPECT_EQ(player_->status().state, PlayState::kPaused);
  const auto end = player_->finish();
  ASSERT_TRUE(end) << end.error().what;
  EXPECT_EQ(*end, Next::kEnd);
}

TEST_F(Playing, SaysWhatCannotBeDoneAndGoesOn) {
  player_->step();
  wait_for_frame(0);
  player_->set({{"levels", 99}});
  wait_for([&] { return player_->status().problem.find("levels") != std::string::npos; });
  player_->select({{&kRightArm, {{JointId::kRightHand, 1e6, 0}}}});
  wait_for([&] { return player_->status().refused == 1; });
  player_->play(true);
  wait_for_end();
  EXPECT_TRUE(player_->finish());
}

TEST_F(Playing, WritesIntoAFileWithTheDate) {
  const TempFolder folder;
  const auto before = std::filesystem::current_path();
  std::filesystem::create_directory(folder / "out");
  std::filesystem::current_path(folder / "out");
  const std::size_t kind = 2;
  player_->put_out(kind, true, "");
  wait_for([&] { return player_->status().outputs[kind].on; });
  const std::string name = player_->status().outputs[kind].name;
  EXPECT_TRUE(name.starts_with("duoptic_2") && name.ends_with(sink_kinds()[kind].target)) << name;
  player_->put_out(kind, false, "");
  wait_for([&] { return !player_->status().outputs[kind].on; });
  EXPECT_TRUE(player_->finish());
  EXPECT_TRUE(std::filesystem::exists(name));
  std::filesystem::current_path(before);
}

}  // namespace
}  // namespace duo
