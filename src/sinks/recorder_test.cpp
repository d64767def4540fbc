// Recordings: every pair comes back as it was, from whole files and from what a kill, a cut or a full disk leaves of them.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "duoptic/recording.h"
#include "duoptic/source.h"
#include "duoptic/synthetic.h"
#include "tests/recorded_pairs.h"

namespace duo {
namespace {

using namespace test;  // NOLINT: the writers of tests/write_media.h

TEST(Recorder, EveryPairComesBackAsItWas) {
  const TempFolder dir;
  for (const bool jpeg : {false, true}) {
    SCOPED_TRACE(jpeg);
    const auto path = dir / (jpeg ? "jpeg.mkv" : "raw.mkv");
    write_recording(path, 9, jpeg);
    const auto source = open_pairs(path, {});
    ASSERT_TRUE(source) << source.error().what;
    EXPECT_EQ((*source)->count(), 9);
    EXPECT_EQ((*source)->size(), kSize);
    EXPECT_EQ((*source)->frame_s(), 33'333'337 * 1e-9);
    ASSERT_TRUE((*source)->rig());
    EXPECT_EQ(json_from_rig(*(*source)->rig()), json_from_rig(*setup_with_rig().rig));
    const Played played = play(path);
    EXPECT_EQ(played.end, Next::kEnd) << played.error;
    EXPECT_EQ(played.warning, "");
    ASSERT_EQ(played.pairs.size(), 9u);
    for (int t = 0; t < 9; ++t) {
      const Pair want = pair_of(t, jpeg);
      const Pair& got = played.pairs[static_cast<std::size_t>(t)];
      EXPECT_EQ(got.sequence, want.sequence);
      for (const auto side : {&Pair::left, &Pair::right}) {
        EXPECT_EQ((got.*side).t_ns, (want.*side).t_ns - kStart_ns);
        EXPECT_EQ((got.*side).sequence, (want.*side).sequence);
        EXPECT_EQ((got.*side).jpeg, (want.*side).jpeg);
        EXPECT_TRUE(jpeg || same((got.*side).pixels, (want.*side).pixels)) << t;
      }
    }
  }
}

TEST(Recorder, TheSamePairsGiveTheSameBytes) {
  const TempFolder dir;
  EXPECT_EQ(write_recording(dir / "a.mkv", 3, false).bytes, write_recording(dir / "b.mkv", 3, false).bytes);
}

/// Nothing that was written is lost: all pairs whose last byte is there are given.
TEST(Recorder, CutAnywhereKeepsItsWholePairs) {
  const TempFolder dir;
  constexpr int kPairs = 24;
  std::mt19937 random(1);
  for (const bool jpeg : {false, true}) {
    const auto name = dir / (jpeg ? "jpeg.mkv" : "raw.mkv");
    const Written whole = write_recording(name, kPairs, jpeg);
    const Played all = play(name);
    ASSERT_EQ(all.pairs.size(), static_cast<std::size_t>(kPairs));
    int cuts = 0, refused = 0;
    for (int i = 0; i < 100; ++i) {
      // Every fifth near the start, where head and first pair lie.
      const std::size_t keep = random() % (i % 5 == 0 ? whole.end_of_pair[0] : whole.bytes.size());
      SCOPED_TRACE(keep);
      put(dir / "cut.mkv", std::string_view(whole.bytes).substr(0, keep));
      const auto written = static_cast<std::size_t>(std::upper_bound(whole.end_of_pair.begin(), whole.end_of_pair.end(), keep) -
                                                    whole.end_of_pair.begin());
      const Played cut = play(dir / "cut.mkv");
      if (!cut.error.empty()) {
        EXPECT_EQ(written, 0u) << cut.error;
        EXPECT_EQ(cut.error.find('\n'), std::string::npos);
        EXPECT_NE(cut.error.find("cut.mkv"), std::string::npos) << cut.error;
        ++refused;
        continue;
      }
      const auto report = inspect_recording(dir / "cut.mkv");
      ASSERT_TRUE(report) << report.error().what;
      EXPECT_EQ(report->cut, cut.end == Next::kCut) << report->pairs;
      EXPECT_GE(report->pairs, static_cast<std::int64_t>(written));
      ASSERT_GE(cut.pairs.size(), written);
      ASSERT_LE(cut.pairs.size(), written + 1);
      EXPECT_TRUE(cut.end == Next::kCut || cut.pairs.size() == kPairs);
      EXPECT_EQ(cut.warning.find("cut.mkv is cut short") != std::string::npos, cut.end == Next::kCut) << cut.warning;
      for (std::size_t t = 0; t < cut.pairs.size(); ++t) {
        EXPECT_TRUE(same(cut.pairs[t].left.pixels, all.pairs[t].left.pixels)) << t;
        EXPECT_TRUE(same(cut.pairs[t].right.pixels, all.pairs[t].right.pixels)) << t;
        EXPECT_EQ(cut.pairs[t].right.t_ns, all.pairs[t].right.t_ns);
      }
      ++cuts;
    }
    EXPECT_GT(cuts, 60);
    EXPECT_GT(refused, 5);
  }
}

/// What a kill leaves is what the file was at that moment.
TEST(Recorder, KilledKeepsAllPairs) {
  const TempFolder dir;
  auto recorder = Recorder::open(dir / "live.mkv", setup_with_rig());
  ASSERT_TRUE(recorder);
  for (int t = 0; t < 6; ++t) ASSERT_TRUE(recorder->write(pair_of(t, true)));
  put(dir / "killed.mkv", bytes_of(dir / "live.mkv"));
  const Played killed = play(dir / "killed.mkv");
  EXPECT_EQ(killed.pairs.size(), 6u) << killed.error;
  EXPECT_EQ(killed.end, Next::kCut);
  const auto report = inspect_recording(dir / "killed.mkv");
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_TRUE(report->cut);
  EXPECT_TRUE(report->rig);
  EXPECT_EQ(report->pairs, 6);
}

TEST(Recorder, FullDiskLeavesAFinishedFile) {
  const TempFolder dir;
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  for (const rlim_t bytes : {90'000u, 131'072u, 200'001u}) {
    SCOPED_TRACE(bytes);
    const rlimit small{bytes, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);  // stands for the full disk
    std::string error;
    std::int64_t pairs = 0;
    {
      auto recorder = Recorder::open(dir / "full.mkv", {.replace = true});
      ASSERT_TRUE(recorder);
      for (int t = 0; t < 60 && error.empty(); ++t)
        if (const auto written = recorder->write(pair_of(t, false)); !written) error = written.error().what;
      pairs = recorder->pairs();
      EXPECT_FALSE(recorder->write(pair_of(0, false)));
    }
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_NE(error.find("File too large"), std::string::npos) << error;
    EXPECT_NE(error.find(std::to_string(pairs) + " pairs, is in it"), std::string::npos) << error;
    EXPECT_GT(pairs, 1);
    const Played played = play(dir / "full.mkv");
    EXPECT_EQ(played.end, Next::kEnd) << played.warning << played.error;
    EXPECT_EQ(static_cast<std::int64_t>(played.pairs.size()), pairs);
    EXPECT_EQ((*open_pairs(dir / "full.mkv", {}))->count(), pairs);  // its index is there
  }
  std::signal(SIGXFSZ, old_handler);
}

TEST(Recorder, NamesThatCannotBeTaken) {
  const TempFolder dir;
  put(dir / "old.mkv", "precious");
  const auto refused = Recorder::open(dir / "old.mkv", {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("choose another name"), std::string::npos) << refused.error().what;
  EXPECT_EQ(bytes_of(dir / "old.mkv"), "precious");
  EXPECT_FALSE(Recorder::open(dir / "none" / "a.mkv", {}));
  EXPECT_FALSE(Recorder::open(dir / "", {}));
  {
    const auto unused = Recorder::open(dir / "empty.mkv", {});
    EXPECT_TRUE(unused);
  }
  EXPECT_FALSE(std::filesystem::exists(dir / "empty.mkv"));  // no pair, no file
}

TEST(Recorder, PicturesUnlikeTheFirstEndIt) {
  const TempFolder dir;
  auto recorder = Recorder::open(dir / "a.mkv", {});
  ASSERT_TRUE(recorder && recorder->write(pair_of(0, true)));
  const auto refused = recorder->write(pair_of(1, false));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("start a new recording"), std::string::npos) << refused.error().what;
  const Played played = play(dir / "a.mkv");
  EXPECT_EQ(played.end, Next::kEnd);
  EXPECT_EQ(played.pairs.size(), 1u);
}

TEST(Recorder, ReportAndFilesOfItsOwn) {
  const TempFolder dir;
  write_recording(dir / "a.mkv", 9, true);
  const auto report = inspect_recording(dir / "a.mkv");
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_EQ(report->left.codec, "mjpeg");
  EXPECT_EQ(report->pairs, 9);
  EXPECT_EQ(report->left.missing, 2);  // numbers 55 and 56
  EXPECT_EQ(report->right.missing, 0);
  EXPECT_NEAR(report->length_s, 8 * 0.033333337, 1e-9);
  EXPECT_NEAR(report->skew_s, 0.004000001, 1e-12);
  EXPECT_FALSE(report->cut);
  const auto exported = export_recording(dir / "a.mkv", {dir / "l.avi", dir / "r.avi", dir / "t.csv"});
  ASSERT_TRUE(exported) << exported.error().what;
  auto left = open_source(dir / "l.avi");
  ASSERT_TRUE(left) << left.error().what;
  Picture picture;
  for (int t = 0; t < 9; ++t) {
    const auto next = (*left)->next(picture);
    ASSERT_TRUE(next && *next == Next::kNew);
    EXPECT_EQ(picture.jpeg, jpeg_of(t));
  }
  EXPECT_EQ(bytes_of(dir / "t.csv").substr(0, 111),
            "pair,left_t_s,right_t_s,left_number,right_number\n"
            "0,0.004000001,0.000000000,50,7\n1,0.037333338,0.037333338,51,8\n");
  put(dir / "words.mkv", "no recording");
  EXPECT_FALSE(inspect_recording(dir / "words.mkv"));
  EXPECT_FALSE(inspect_recording(dir / "l.avi"));
}

TEST(RealTime, GivesPairsWhenTheyAreDueAndDropsLateOnes) {
  const TempFolder dir;
  write_recording(dir / "a.mkv", 9, true);
  auto opened = open_pairs(dir / "a.mkv", {});
  ASSERT_TRUE(opened);
  const auto source = in_real_time(std::move(*opened));
  EXPECT_TRUE(source->live());
  EXPECT_TRUE(source->rig());
  const auto now_ns = [] { return std::chrono::steady_clock::now().time_since_epoch().count(); };
  std::vector<std::uint64_t> given;
  Pair pair;
  while (true) {
    const auto next = source->next(pair);
    ASSERT_TRUE(next);
    if (*next == Next::kNothing) continue;
    if (*next == Next::kEnd) break;
    EXPECT_GE(now_ns(), pair.left.t_ns);  // never before its time
    given.push_back(pair.sequence);
    if (given.size() == 2) std::this_thread::sleep_for(std::chrono::milliseconds(110));
  }
  EXPECT_EQ(given.front(), 0u);
  EXPECT_EQ(given.back(), 8u);
  EXPECT_GE(source->dropped(), 1);
  EXPECT_EQ(static_cast<std::int64_t>(given.size()) + source->dropped(), 9);
}

}  // namespace
}  // namespace duo
