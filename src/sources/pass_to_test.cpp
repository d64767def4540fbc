// Passing over pairs of files: what follows is what a run of all pairs gives, bit for bit, with an index or without.
#include <gtest/gtest.h>

#include <cstring>

#include "duoptic/recording.h"
#include "sources/file_source.h"
#include "tests/write_media.h"

namespace duo {
namespace {

using namespace test;  // NOLINT: the writers of tests/write_media.h

constexpr int kLong = 40;

std::vector<Pair> rest_of(PairSource& pairs) {
  std::vector<Pair> out;
  for (Pair pair;;) {
    const auto next = pairs.next(pair);
    EXPECT_TRUE(next) << next.error().what;
    if (!next || *next != Next::kNew) return out;
    out.push_back(std::move(pair));
    pair = {};
  }
}

bool have_same_pixels(const Image<Rgb8>& a, const Image<Rgb8>& b) {
  if (a.size() != b.size()) return false;
  for (int y = 0; y < a.height(); ++y)
    if (std::memcmp(a.row(y), b.row(y), sizeof(Rgb8) * static_cast<std::size_t>(a.width())) != 0) return false;
  return true;
}

void expect_same_pair(const Pair& a, const Pair& b) {
  EXPECT_EQ(a.sequence, b.sequence);
  EXPECT_EQ(a.left.t_ns, b.left.t_ns);
  EXPECT_EQ(a.right.t_ns, b.right.t_ns);
  EXPECT_TRUE(have_same_pixels(a.left.pixels, b.left.pixels) && have_same_pixels(a.right.pixels, b.right.pixels));
}

/// From every number of pairs read to every number passed to; also beyond the end.
void expect_the_same_after_passing(const std::filesystem::path& left, const std::filesystem::path& right,
                                   const PairWish& wish = {}) {
  SCOPED_TRACE(left.string());
  auto whole = open_pairs(left, right, wish);
  ASSERT_TRUE(whole) << whole.error().what;
  const std::vector<Pair> all = rest_of(**whole);
  ASSERT_GT(all.size(), 20u);
  for (const std::size_t read : {0, 1, 5})
    for (std::size_t to : {read, read + 1, std::size_t{9}, std::size_t{17}, all.size() - 1, all.size(), all.size() + 7}) {
      SCOPED_TRACE(std::to_string(read) + " to " + std::to_string(to));
      auto opened = open_pairs(left, right, wish);
      ASSERT_TRUE(opened);
      auto* const pairs = dynamic_cast<FilePairs*>(opened->get());
      ASSERT_NE(pairs, nullptr);
      Pair pair;
      for (std::size_t i = 0; i < read; ++i) ASSERT_EQ(*pairs->next(pair), Next::kNew);
      const auto reached = pairs->pass_to(to);
      ASSERT_TRUE(reached) << reached.error().what;
      to = std::min(to, all.size());
      EXPECT_EQ(*reached, to);
      const std::vector<Pair> rest = rest_of(*pairs);
      ASSERT_EQ(rest.size(), all.size() - to);
      for (std::size_t i = 0; i < rest.size(); ++i) expect_same_pair(rest[i], all[to + i]);
      EXPECT_EQ(*pairs->next(pair), Next::kEnd);
      EXPECT_EQ(pairs->warning(), (*whole)->warning());
    }
}

std::vector<int> most_of(int count, int without, int also_without) {
  std::vector<int> out;
  for (int t = 0; t < count; ++t)
    if (t != without && t != also_without) out.push_back(t);
  return out;
}

TEST(PassTo, VideosThatPairByTimes) {
  const TempFolder dir;
  for (const std::string kind : {".avi", ".mov", ".mkv"}) {  // Matroska of others has no picture's index: it is read
    write_video_at(dir / ("left" + kind), AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, most_of(kLong, 11, 12));
    write_video_at(dir / ("right" + kind), AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, most_of(kLong, 3, 20));
    const auto left = open_source(dir / ("left" + kind));
    ASSERT_TRUE(left);
    EXPECT_EQ(dynamic_cast<FileSource&>(**left).indexed_times().size(), kind == ".mkv" ? 0u : 38u) << kind;
    expect_the_same_after_passing(dir / ("left" + kind), dir / ("right" + kind));
  }
  expect_the_same_after_passing(dir / "left.avi", dir / "right.avi", {.skew_ns = 40'000'000});
}

TEST(PassTo, PicturesThatNeedOthers) {
  const TempFolder dir;
  for (const std::string side : {"left", "right"})
    write_video_at(dir / (side + ".mp4"), AV_CODEC_ID_MPEG4, AV_PIX_FMT_YUV420P, most_of(kLong, side == "left" ? 8 : 30, 9),
                   {.b_frames = 2, .key_every = 10});
  expect_the_same_after_passing(dir / "left.mp4", dir / "right.mp4");
}

TEST(PassTo, HalvesOfOneFile) {
  const TempFolder dir;
  write_video_at(dir / "both.avi", AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, most_of(kLong, 5, 6));
  expect_the_same_after_passing(dir / "both.avi", {}, {.layout = ViewLayout::kSideBySide});
}

TEST(PassTo, ARecording) {
  const TempFolder dir;
  auto recorder = Recorder::open(dir / "clip.mkv", {.frame_s = 1.0 / 30});
  ASSERT_TRUE(recorder);
  for (int i = 0; i < kLong; ++i) {
    Pair pair;
    for (Picture* picture : {&pair.left, &pair.right}) {
      picture->pixels = Image<Rgb8>(kSize);
      for (int y = 0; y < kSize.height; ++y)
        for (int x = 0; x < kSize.width; ++x)
          picture->pixels.at(y, x) = {static_cast<std::uint8_t>(i * 5 + x), static_cast<std::uint8_t>(y * 3),
                                      static_cast<std::uint8_t>(picture == &pair.left ? 20 : 90)};
      picture->t_ns = TimeNs{i} * 33'333'333 + (picture == &pair.left ? 0 : 7'654'321 + i * 1000);
    }
    ASSERT_TRUE(recorder->write(pair));
  }
  ASSERT_TRUE(recorder->finish());
  const auto view = open_view(dir / "clip.mkv", 1);
  ASSERT_TRUE(view);
  EXPECT_TRUE(dynamic_cast<FileSource&>(**view).prepare_seek());
  expect_the_same_after_passing(dir / "clip.mkv", {});
  // One that was cut has no index: its pairs are read, and it says that it was cut.
  const std::string bytes = bytes_of(dir / "clip.mkv");
  put(dir / "cut.mkv", std::string_view(bytes).substr(0, bytes.size() * 3 / 4));
  auto cut = open_pairs(dir / "cut.mkv", {});
  ASSERT_TRUE(cut);
  ASSERT_EQ(*dynamic_cast<FilePairs&>(**cut).pass_to(10), 10u);
  Pair pair;
  ASSERT_EQ(*(*cut)->next(pair), Next::kNew);
  EXPECT_EQ(pair.sequence, 10u);
  EXPECT_EQ(pair.left.pixels.at(0, 0).r, 50);
}

}  // namespace
}  // namespace duo
