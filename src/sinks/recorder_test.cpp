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
#include "tests/write_media.h"

namespace duo {
namespace {

using namespace test;  // NOLINT: the writers of tests/write_media.h

/// Noise and slopes in RGB: nothing that 4:2:0 could keep.
Image<Rgb8> pixels_of(int t, int side) {
  std::mt19937 random(static_cast<unsigned>(2 * t + side));
  Image<Rgb8> out(kSize);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      out.at(y, x) = {static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(4 * x + t),
                      static_cast<std::uint8_t>(5 * y)};
  return out;
}

std::vector<std::uint8_t> jpeg_of(int t) {
  Encoder encoder = make_encoder(AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P);
  std::vector<std::uint8_t> bytes;
  encoder.encode(pattern(AV_PIX_FMT_YUVJ420P, t).get(), [&](AVPacket& p) { bytes.assign(p.data, p.data + p.size); });
  return bytes;
}

/// Pair number t of two free-running cameras: odd nanoseconds, a right picture that is earlier or later, numbers that skip.
Pair pair_of(int t, bool jpeg) {
  Pair pair;
  pair.left.pixels = pixels_of(t, 0);
  pair.right.pixels = pixels_of(t, 1);
  if (jpeg) {
    pair.left.jpeg = jpeg_of(t);
    pair.right.jpeg = jpeg_of(100 + t);
  }
  pair.left.t_ns = 987'654'321'123 + std::int64_t{t} * 33'333'337;
  pair.right.t_ns = pair.left.t_ns + (t % 3 - 1) * 4'000'001;
  pair.left.sequence = static_cast<std::uint64_t>(50 + t + (t > 4 ? 2 : 0));
  pair.right.sequence = static_cast<std::uint64_t>(7 + t);
  pair.sequence = static_cast<std::uint64_t>(t);
  return pair;
}
constexpr TimeNs kStart_ns = 987'654'321'123 - 4'000'001;  // the first right picture

RecorderSetup setup_with_rig() { return {.frame_s = 0.033333337, .rig = synthetic_rig({.size = kSize})}; }

struct Written {
  std::string bytes;
  std::vector<std::size_t> end_of_pair;  // bytes of the file when each pair was in it
};

Written write_recording(const std::filesystem::path& path, int pairs, bool jpeg) {
  Written out;
  auto recorder = Recorder::open(path, setup_with_rig());
  EXPECT_TRUE(recorder) << recorder.error().what;
  for (int t = 0; t < pairs; ++t) {
    EXPECT_TRUE(recorder->write(pair_of(t, jpeg)));
    out.end_of_pair.push_back(static_cast<std::size_t>(recorder->bytes()));
    EXPECT_EQ(std::filesystem::file_size(path), out.end_of_pair.back());  // with the system, not in our memory
  }
  EXPECT_TRUE(recorder->finish());
  out.bytes = bytes_of(path);
  return out;
}

struct Played {
  std::vector<Pair> pairs;
  Next end = Next::kPicture;
  std::string warning, error;
};

Played play(const std::filesystem::path& path) {
  Played out;
  auto source = open_pairs(path, {});
  if (!source) {
    out.error = source.error().what;
    return out;
  }
  while (true) {
    Pair pair;
    const auto next = (*source)->next(pair);
    if (!next) out.error = next.error().what;
    if (next) out.end = *next;
    out.warning = (*source)->warning();
    if (!next || *next != Next::kPicture) return out;
    out.pairs.push_back(std::move(pair));
  }
}

bool same(const Image<Rgb8>& a, const Image<Rgb8>& b) {
  if (a.size() != b.size()) return false;
  for (int y = 0; y < a.height(); ++y)
    if (!std::equal(a.row(y), a.row(y) + a.width(), b.row(y))) return false;
  return true;
}

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
    ASSERT_TRUE(next && *next == Next::kPicture);
    EXPECT_EQ(picture.jpeg, jpeg_of(t));
  }
  EXPECT_EQ(bytes_of(dir / "t.csv").substr(0, 111),
            "pair,left_t_s,right_t_s,left_number,right_number\n"
            "0,0.004000001,0.000000000,50,7\n1,0.037333338,0.037333338,51,8\n");
  put(dir / "words.mkv", "no recording");
  EXPECT_FALSE(inspect_recording(dir / "words.mkv"));
  EXPECT_FALSE(inspect_recording(dir / "l.avi"));
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
