// What the record button and track --record do: every pair of a live source, and what becomes of it when the disk or its folder
// says no.
#include "pipeline/tap.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/write_media.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

constexpr int kPairs = 20;

/// Twenty pairs as they come from cameras, then a pause without any.
class Cameras final : public PairSource {
 public:
  Size size() const override { return {64, 48}; }
  std::int64_t count() const override { return 0; }
  bool still() const override { return false; }
  bool live() const override { return true; }
  std::string warning() const override { return {}; }
  const std::thread::id* asked_by() const { return &asked_by_; }
  Result<Next> next(Pair& into) override {
    asked_by_ = std::this_thread::get_id();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    if (given_ == kPairs) return Next::kNothing;
    for (Picture Pair::*side : {&Pair::left, &Pair::right}) {
      Picture& picture = into.*side;
      picture.pixels = Image<Rgb8>(size());
      for (int y = 0; y < size().height; ++y)
        for (int x = 0; x < size().width; ++x) {
          const auto noise = static_cast<std::uint32_t>(x * 7919 + y * 104729 + given_ * 15485863) * 2654435761U;
          picture.pixels.at(y, x) = {static_cast<std::uint8_t>(noise >> 24), static_cast<std::uint8_t>(noise >> 16),
                                     static_cast<std::uint8_t>(noise >> 8)};
        }
      picture.t_ns = TimeNs{given_} * 33'333'333;
      picture.sequence = static_cast<std::uint64_t>(given_);
    }
    into.sequence = static_cast<std::uint64_t>(given_++);
    return Next::kNew;
  }

 private:
  int given_ = 0;
  std::thread::id asked_by_;
};

/// Recordings go to the working folder.
class RecordingOnTheWay : public ::testing::Test {
 protected:
  RecordingOnTheWay() : before_(fs::current_path()) { fs::current_path(folder_ / "."); }
  ~RecordingOnTheWay() override { fs::current_path(before_); }

  static RecordingReport report_of(const RecordingStatus& status) {
    const auto report = inspect_recording(status.name);
    EXPECT_TRUE(report) << report.error().what;
    return report ? *report : RecordingReport{};
  }
  /// Until the source has given all, or the recording is over.
  void play(PairSource& tap) {
    for (int i = 0; i < 1000 && recording_->status().pairs < kPairs && recording_->status().on; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_EQ(*tap.next(pair_), Next::kNew);
  }

  const test::TempFolder folder_;
  const fs::path before_;
  const std::shared_ptr<Recording> recording_ = std::make_shared<Recording>();
  Pair pair_;
};

TEST_F(RecordingOnTheWay, HasThePairsThatNobodyTookInTime) {
  ASSERT_TRUE(recording_->start("clip.mkv", {}, 0));
  Tap tap(std::make_unique<Cameras>(), recording_);
  ASSERT_TRUE(tap.read_all_pairs());
  play(tap);
  EXPECT_EQ(pair_.sequence, kPairs - 1U);  // the newest
  EXPECT_EQ(tap.dropped(), kPairs - 1);
  recording_->stop();
  const RecordingStatus status = recording_->status();
  EXPECT_FALSE(status.on);
  EXPECT_EQ(status.problem, "");
  EXPECT_NEAR(status.length_s, (kPairs - 1) / 30.0, 1e-6);
  const RecordingReport report = report_of(status);
  EXPECT_EQ(report.pairs, kPairs);
  EXPECT_EQ(report.left.missing, 0);
  EXPECT_FALSE(report.cut);

  // One without a pair.
  ASSERT_TRUE(recording_->start("none.mkv", {}, 0));
  recording_->stop();
  EXPECT_FALSE(fs::exists("none.mkv"));
  EXPECT_TRUE(fs::exists(status.name));
}

TEST_F(RecordingOnTheWay, NeedsNoThreadBeforeThereIsOne) {
  auto cameras = std::make_unique<Cameras>();
  const std::thread::id* asked_by = cameras->asked_by();
  Tap tap(std::move(cameras), recording_);
  for (int i = 0; i < 3; ++i) ASSERT_EQ(*tap.next(pair_), Next::kNew);
  EXPECT_EQ(*asked_by, std::this_thread::get_id());

  ASSERT_TRUE(recording_->start("clip.mkv", {}, 0));
  ASSERT_TRUE(tap.read_all_pairs());
  for (int i = 0; i < 1000 && recording_->status().pairs < kPairs - 3; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ASSERT_EQ(*tap.next(pair_), Next::kNew);
  EXPECT_EQ(pair_.sequence, kPairs - 1U);
  recording_->stop();
  EXPECT_EQ(report_of(recording_->status()).pairs, kPairs - 3);
}

TEST_F(RecordingOnTheWay, EndsByItselfAtItsLength) {
  ASSERT_TRUE(recording_->start("clip.mkv", {}, 0.3));
  Tap tap(std::make_unique<Cameras>(), recording_);
  ASSERT_TRUE(tap.read_all_pairs());
  play(tap);
  const RecordingStatus status = recording_->status();
  EXPECT_FALSE(status.on);
  EXPECT_EQ(status.pairs, 10);  // the pairs at 0 to 9 thirtieths of a second
  EXPECT_EQ(report_of(status).pairs, 10);
}

TEST_F(RecordingOnTheWay, FullDiskKeepsWhatWasWritten) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  constexpr rlim_t kRoom = 150'000;  // stands for the full disk
  const rlimit small = {kRoom, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  ASSERT_TRUE(recording_->start("clip.mkv", {}, 0));
  {
    Tap tap(std::make_unique<Cameras>(), recording_);
    ASSERT_TRUE(tap.read_all_pairs());
    play(tap);  // what is watched goes on
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  const RecordingStatus status = recording_->status();
  EXPECT_FALSE(status.on);
  EXPECT_NE(status.problem.find("is in it"), std::string::npos) << status.problem;
  ASSERT_TRUE(recording_->first_failure());
  EXPECT_EQ(recording_->first_failure()->code, ErrorCode::kWriteFailed);
  const RecordingReport report = report_of(status);
  EXPECT_GT(report.pairs, 0);
  EXPECT_LT(report.pairs, kPairs);
  EXPECT_EQ(report.pairs, status.pairs);
  EXPECT_FALSE(report.cut);
}

TEST_F(RecordingOnTheWay, SaysThatItsFolderCannotBeWritten) {
  const fs::path gone = folder_ / "gone";
  fs::create_directory(gone);
  fs::current_path(gone);
  fs::remove(gone);
  EXPECT_FALSE(recording_->start("clip.mkv", {}, 0));
  EXPECT_FALSE(recording_->status().on);
  EXPECT_NE(recording_->status().problem.find("cannot write 'clip"), std::string::npos) << recording_->status().problem;
  EXPECT_EQ(recording_->first_failure()->code, ErrorCode::kWriteFailed);
}

}  // namespace
}  // namespace duo
