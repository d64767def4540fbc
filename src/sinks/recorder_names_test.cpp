// A recording's name, which others may take while it is made; and times of recordings that others made.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/recorded_pairs.h"

namespace duo {
namespace {

using namespace test;  // NOLINT: the pairs of tests/recorded_pairs.h

/// Whatever takes the name between open() and the first pair is not written, and nothing waits for it.
TEST(Recorder, WhatOthersPutInItsPlaceStays) {
  const TempFolder dir;
  put(dir / "precious", "precious");
  for (const std::string what : {"file", "link", "pipe"}) {
    SCOPED_TRACE(what);
    for (const bool writes : {true, false}) {
      auto recorder = Recorder::open(dir / "a.mkv", {});
      ASSERT_TRUE(recorder) << recorder.error().what;
      std::filesystem::remove(dir / "a.mkv");
      if (what == "file") put(dir / "a.mkv", "theirs");
      if (what == "link") std::filesystem::create_symlink(dir / "precious", dir / "a.mkv");
      if (what == "pipe") {
        ASSERT_EQ(mkfifo((dir / "a.mkv").c_str(), 0600), 0);
      }
      if (writes) {
        const auto written = recorder->write(pair_of(0, true));
        ASSERT_FALSE(written);
        EXPECT_EQ(written.error().code, ErrorCode::kWriteFailed);
        EXPECT_NE(written.error().what.find("a.mkv"), std::string::npos) << written.error().what;
        if (what == "file") {
          EXPECT_EQ(bytes_of(dir / "a.mkv"), "theirs");
        }
      }
      EXPECT_TRUE(recorder->finish());
      if (writes) std::filesystem::remove(dir / "a.mkv");
    }
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::symlink_status(dir / "a.mkv")));
    EXPECT_EQ(bytes_of(dir / "precious"), "precious");
    if (what == "file") {
      EXPECT_EQ(bytes_of(dir / "a.mkv"), "theirs");
    }
    std::filesystem::remove(dir / "a.mkv");
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir / ""), std::filesystem::directory_iterator()), 1);
}

TEST(Recorder, AnEarlierOneIsReplacedByTheFirstPair) {
  const TempFolder dir;
  put(dir / "precious", "precious");
  std::filesystem::create_symlink(dir / "precious", dir / "a.mkv");
  { ASSERT_TRUE(Recorder::open(dir / "a.mkv", {.replace = true})); }
  EXPECT_EQ(bytes_of(dir / "a.mkv"), "precious");  // no pair: as it was
  auto recorder = Recorder::open(dir / "a.mkv", {.replace = true});
  ASSERT_TRUE(recorder && recorder->write(pair_of(0, true)) && recorder->finish());
  EXPECT_EQ(play(dir / "a.mkv").pairs.size(), 1u);
  EXPECT_EQ(bytes_of(dir / "precious"), "precious");
  auto late = Recorder::open(dir / "a.mkv", {.replace = true}), later = Recorder::open(dir / "a.mkv", {.replace = true});
  ASSERT_TRUE(late && later);
  for (int t = 0; t < 3; ++t) ASSERT_TRUE(late->write(pair_of(t, true)) && later->write(pair_of(t, true)));
  ASSERT_TRUE(later->write(pair_of(3, true)) && late->finish() && later->finish());
  const Played played = play(dir / "a.mkv");
  EXPECT_EQ(played.pairs.size(), 4u) << played.error;
  EXPECT_EQ(played.end, Next::kEnd);
}

/// Two tracks of JPEGs that another program wrote, a pair each 40 ms, in units of `scale_ns`.
void write_others(const std::filesystem::path& path, std::uint32_t scale_ns) {
  AVFormatContext* muxer = nullptr;
  ASSERT_GE(avformat_alloc_output_context2(&muxer, nullptr, "matroska", nullptr), 0);
  for (int track = 0; track < 2; ++track) {
    AVStream* stream = avformat_new_stream(muxer, nullptr);
    stream->codecpar->codec_type = AVMEDIA_TYPE_VIDEO;
    stream->codecpar->codec_id = AV_CODEC_ID_MJPEG;
    stream->codecpar->width = kSize.width;
    stream->codecpar->height = kSize.height;
  }
  ASSERT_GE(avio_open(&muxer->pb, path.c_str(), AVIO_FLAG_WRITE), 0);
  ASSERT_GE(avformat_write_header(muxer, nullptr), 0);
  for (int t = 0; t < 4; ++t)
    for (int track = 0; track < 2; ++track) {
      const auto jpeg = jpeg_of(t);
      const av::Packet packet(av_packet_alloc());
      ASSERT_GE(av_new_packet(packet.get(), static_cast<int>(jpeg.size())), 0);
      std::copy(jpeg.begin(), jpeg.end(), packet->data);
      packet->stream_index = track;
      packet->flags |= AV_PKT_FLAG_KEY;
      packet->pts = packet->dts = 40'000'000LL * t / scale_ns;  // the muxer counts ms: its scale is changed below
      ASSERT_GE(av_write_frame(muxer, packet.get()), 0);
    }
  ASSERT_GE(av_write_trailer(muxer), 0);
  avio_closep(&muxer->pb);
  avformat_free_context(muxer);
  std::string bytes = bytes_of(path);
  const std::size_t scale = bytes.find("\x2A\xD7\xB1\x83\x0F\x42\x40");  // TimestampScale, 1000000 ns
  ASSERT_NE(scale, std::string::npos);
  for (std::size_t i = 0; i < 3; ++i) bytes[scale + 4 + i] = static_cast<char>(scale_ns >> (8 * (2 - i)));
  put(path, bytes);
}

/// Every reader of times gives seconds, whatever unit the file counts in.
TEST(Recorder, TimesOfAnyScale) {
  const TempFolder dir;
  for (const std::uint32_t scale_ns : {1'000'000u, 100'000u, 250'000u, 10'000'000u}) {
    SCOPED_TRACE(scale_ns);
    write_others(dir / "a.mkv", scale_ns);
    const auto exported = export_recording(dir / "a.mkv", {dir / "l.avi", dir / "r.avi", dir / "t.csv"});
    ASSERT_TRUE(exported) << exported.error().what;
    EXPECT_EQ(bytes_of(dir / "t.csv"),
              "pair,left_t_s,right_t_s,left_number,right_number\n0,0.000000000,0.000000000,0,0\n"
              "1,0.040000000,0.040000000,1,1\n2,0.080000000,0.080000000,2,2\n3,0.120000000,0.120000000,3,3\n");
    const auto report = inspect_recording(dir / "a.mkv");
    ASSERT_TRUE(report) << report.error().what;
    EXPECT_NEAR(report->length_s, 0.12, 1e-9);
    EXPECT_NEAR(report->longest_gap_s, 0.04, 1e-9);
    const Played played = play(dir / "a.mkv");
    ASSERT_EQ(played.pairs.size(), 4u) << played.error;
    for (int t = 0; t < 4; ++t) EXPECT_EQ(played.pairs[static_cast<std::size_t>(t)].right.t_ns, 40'000'000LL * t);
  }
}

}  // namespace
}  // namespace duo
