// Videos pair by their times, whatever is missing, late, slower or damaged; a cut is told from a file that is whole; one file
// holds both views as it says.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "duoptic/source.h"
#include "tests/write_media.h"

namespace duo {
namespace {

using namespace test;  // NOLINT: the writers of tests/write_media.h

std::vector<int> ticks(int from, int to, int step = 1) {
  std::vector<int> out;
  for (int t = from; t < to; t += step) out.push_back(t);
  return out;
}
std::vector<int> without(std::vector<int> times, const std::set<int>& missing) {
  std::erase_if(times, [&](int t) { return missing.contains(t); });
  return times;
}

/// Which pattern a picture shows: the one nearest to it at some of its pixels.
int shown_in(const Picture& picture) {
  static const auto truths = [] {
    std::map<int, av::DecodedFrame> out;
    for (int t = 0; t < 70; ++t) out[t] = pattern(AV_PIX_FMT_GRAY8, t);
    return out;
  }();
  int best = -1;
  long least = 1L << 60;
  for (const auto& [t, truth] : truths) {
    long sum = 0;
    for (int y = 0; y < kSize.height && sum < least; ++y)
      for (int x = 0; x < kSize.width; ++x)
        sum += std::abs(picture.pixels.at(y, x).g - truth->data[0][y * truth->linesize[0] + x]);
    if (sum < least) least = sum, best = t;
  }
  return best;
}

struct PairsRead {
  std::vector<std::pair<int, int>> shown;  // of each pair, left and right
  std::vector<double> skews_ms;
  Next end = Next::kNew;
  std::string warning, error;
};

PairsRead read_pairs(const std::filesystem::path& left, const std::filesystem::path& right, const PairWish& wish = {}) {
  PairsRead out;
  auto pairs = open_pairs(left, right, wish);
  if (!pairs) return out.error = pairs.error().what, out;
  for (Pair pair;;) {
    const auto next = (*pairs)->next(pair);
    if (!next) return out.error = next.error().what, out;
    out.end = *next;
    if (*next != Next::kNew) break;
    EXPECT_EQ(pair.sequence, out.shown.size());
    out.shown.emplace_back(shown_in(pair.left), shown_in(pair.right));
    out.skews_ms.push_back(static_cast<double>(pair.right.t_ns - pair.left.t_ns) * 1e-6);
  }
  out.warning = (*pairs)->warning();
  return out;
}

void write_gray(const std::filesystem::path& path, const std::vector<int>& times, const VideoStyle& style = {}) {
  const bool mp4 = path.extension() == ".mp4";
  write_video_at(path, mp4 ? AV_CODEC_ID_MJPEG : AV_CODEC_ID_FFV1, mp4 ? AV_PIX_FMT_YUVJ420P : AV_PIX_FMT_GRAY8, times, style);
}

TEST(FilePairs, WhatACameraDropsTakesItsPartnerAlongAndNoOther) {
  const TempFolder dir;
  for (const std::string kind : {".avi", ".mkv", ".mp4"}) {
    SCOPED_TRACE(kind);
    const auto left = dir / ("left" + kind), right = dir / ("right" + kind);
    write_gray(left, without(ticks(0, 30), {11, 12, 20}));
    write_gray(right, without(ticks(0, 30), {3, 7}));
    const PairsRead read = read_pairs(left, right);
    EXPECT_EQ(read.error, "");
    ASSERT_EQ(read.shown.size(), 25u);
    for (const auto& [l, r] : read.shown) EXPECT_EQ(l, r);
    for (const double skew : read.skews_ms) EXPECT_NEAR(skew, 0, 0.6);
    EXPECT_EQ(read.end, Next::kEnd);
    EXPECT_NE(read.warning.find("left out: 2 of 27 left pictures, 3 of 28 right ones"), std::string::npos) << read.warning;
    EXPECT_EQ(read.warning.find('\n'), std::string::npos);
  }
}

TEST(FilePairs, UnlikeRatesTakeTheNearest) {
  const TempFolder dir;
  write_gray(dir / "left.mkv", ticks(0, 60, 2), {.unit = {1, 60}});   // 30 a second
  write_gray(dir / "right.mkv", ticks(0, 60, 3), {.unit = {1, 60}});  // 20 a second
  for (const bool swapped : {false, true}) {
    const PairsRead read = read_pairs(dir / (swapped ? "right.mkv" : "left.mkv"), dir / (swapped ? "left.mkv" : "right.mkv"));
    ASSERT_EQ(read.shown.size(), 20u) << read.error << read.warning << ::testing::PrintToString(read.shown)
                                      << ::testing::PrintToString(read.skews_ms);
    for (std::size_t i = 0; i < 20; ++i) {
      EXPECT_LE(std::abs(read.shown[i].first - read.shown[i].second), 1);
      EXPECT_NEAR(read.skews_ms[i], (read.shown[i].second - read.shown[i].first) * 1000.0 / 60, 1.1);
    }
    EXPECT_EQ(read.end, Next::kEnd);
  }
  write_gray(dir / "short.mkv", ticks(0, 30, 2), {.unit = {1, 60}});  // 15 pictures, 10 of which have a partner
  EXPECT_NE(read_pairs(dir / "right.mkv", dir / "short.mkv").warning.find("short.mkv ends after 15 pictures"), std::string::npos);
}

TEST(FilePairs, InterlacedPicturesAreSaid) {
  const TempFolder dir;
  write_gray(dir / "left.mkv", ticks(0, 4), {.stream = [](AVStream& s) { s.codecpar->field_order = AV_FIELD_TT; }});
  write_gray(dir / "right.mkv", ticks(0, 4));
  const PairsRead read = read_pairs(dir / "left.mkv", dir / "right.mkv");
  EXPECT_EQ(read.shown.size(), 4u) << read.error;
  EXPECT_NE(read.warning.find("left.mkv is interlaced"), std::string::npos) << read.warning;
  EXPECT_EQ(read.warning.find("right.mkv"), std::string::npos) << read.warning;
}

TEST(FilePairs, RatesThatVary) {
  const TempFolder dir;
  const std::vector<int> left = {0, 1, 2, 4, 6, 7, 8, 9, 12, 15, 18, 20, 22, 23, 24, 26};
  write_gray(dir / "left.mkv", left);
  write_gray(dir / "right.mkv", ticks(0, 30));
  const PairsRead read = read_pairs(dir / "left.mkv", dir / "right.mkv");
  ASSERT_EQ(read.shown.size(), left.size()) << read.error;
  for (std::size_t i = 0; i < left.size(); ++i) EXPECT_EQ(read.shown[i], std::pair(left[i], left[i]));
}

TEST(FilePairs, ACameraThatBeginsLater) {
  const TempFolder dir;
  write_gray(dir / "left.mkv", ticks(0, 60));
  write_gray(dir / "later.mkv", ticks(25, 60));  // its times say so
  const auto expect_late = [](const PairsRead& read) {
    ASSERT_EQ(read.shown.size(), 35u) << read.error;
    EXPECT_EQ(read.shown.front(), std::pair(25, 25));
    EXPECT_NE(read.warning.find("25 of 60 left pictures"), std::string::npos) << read.warning;
  };
  expect_late(read_pairs(dir / "left.mkv", dir / "later.mkv"));
  // Times that begin at 0, and who recorded them knows by how much later: more than any frame time.
  write_gray(dir / "from_0.avi", ticks(0, 35));
  const PairsRead told = read_pairs(dir / "left.mkv", dir / "from_0.avi", {.skew_ns = 833'333'333});
  ASSERT_EQ(told.shown.size(), 35u) << told.error;
  for (const auto& [l, r] : told.shown) EXPECT_EQ(l, r + 25);
  for (const double skew : told.skews_ms) EXPECT_NEAR(skew, 0, 0.6);
  const PairsRead apart = read_pairs(dir / "left.mkv", dir / "from_0.avi", {.skew_ns = 60'000'000'000});
  EXPECT_NE(apart.error.find("--skew-ms"), std::string::npos) << apart.error;
}

/// Two recordings in one file, each of which begins at 0: all pictures pair, and it is said.
TEST(FilePairs, TimesThatGoBackGoOn) {
  const TempFolder dir;
  for (const char* name : {"left.ts", "right.ts"}) {
    write_video_at(dir / name, AV_CODEC_ID_MPEG2VIDEO, AV_PIX_FMT_YUV420P, ticks(0, 12), {.key_every = 1});
    const std::string once = bytes_of(dir / name);
    put(dir / name, once + once);
  }
  const PairsRead read = read_pairs(dir / "left.ts", dir / "right.ts");
  EXPECT_EQ(read.error, "");
  ASSERT_GE(read.shown.size(), 22u) << read.warning;
  for (const auto& [l, r] : read.shown) EXPECT_EQ(l, r);
  EXPECT_NE(read.warning.find("left.ts go back at picture "), std::string::npos) << read.warning;
  EXPECT_NE(read.warning.find("right.ts go back at picture "), std::string::npos) << read.warning;
}

TEST(FilePairs, OnlyMissingBytesAreACut) {
  const TempFolder dir;
  struct Whole {
    const char* name;
    AVCodecID codec;
    AVPixelFormat format;
    std::vector<int> times;
    VideoStyle style;
  };
  const std::vector<int> slower = {0, 1, 2, 3, 4, 5, 6, 9, 13, 18, 24, 40}, half = ticks(0, 24, 2);
  const Whole kinds[] = {
      {"slower.avi", AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, slower, {}},
      {"slower.mkv", AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, slower, {}},
      {"slower.mp4", AV_CODEC_ID_MPEG4, AV_PIX_FMT_YUV420P, slower, {.b_frames = 2}},
      {"half.avi", AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, half, {}},
      {"no_index.mkv", AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, slower, {.muxer = {{"live", "1"}}}},
      {"parts.mp4",
       AV_CODEC_ID_MPEG4,
       AV_PIX_FMT_YUV420P,
       slower,
       {.key_every = 3, .muxer = {{"movflags", "frag_keyframe+empty_moov"}}}},
      {"stream.ts", AV_CODEC_ID_MPEG2VIDEO, AV_PIX_FMT_YUV420P, ticks(0, 12), {.b_frames = 2}},
  };
  for (const Whole& kind : kinds) {
    SCOPED_TRACE(kind.name);
    write_video_at(dir / kind.name, kind.codec, kind.format, kind.times, kind.style);
    const PairsRead whole = read_pairs(dir / kind.name, dir / kind.name);
    EXPECT_EQ(whole.shown.size(), kind.times.size()) << whole.error;
    EXPECT_EQ(whole.end, Next::kEnd) << whole.warning;
    const std::string bytes = bytes_of(dir / kind.name);
    put(dir / "cut", std::string_view(bytes).substr(0, bytes.size() * 6 / 10));
    const PairsRead cut = read_pairs(dir / "cut", dir / "cut");
    EXPECT_TRUE(!cut.error.empty() || cut.end == Next::kCut);
    EXPECT_LT(cut.shown.size(), whole.shown.size());
  }
}

/// Zeros in the middle of the `n`-th packet.
void spoil(const std::filesystem::path& path, int n) {
  AVFormatContext* container = nullptr;
  ASSERT_GE(avformat_open_input(&container, path.c_str(), nullptr, nullptr), 0);
  const av::Packet packet(av_packet_alloc());
  for (int i = 0; i <= n; ++i) {
    av_packet_unref(packet.get());
    ASSERT_GE(av_read_frame(container, packet.get()), 0);
  }
  const std::string coded(reinterpret_cast<const char*>(packet->data), static_cast<std::size_t>(packet->size));
  avformat_close_input(&container);
  std::string bytes = bytes_of(path);
  const std::size_t at = bytes.find(coded);
  ASSERT_NE(at, std::string::npos);
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at + coded.size() / 4), coded.size() / 2, '\0');
  put(path, bytes);
}

TEST(FilePairs, ADamagedPictureIsLeftOutAndSaid) {
  const TempFolder dir;
  write_gray(dir / "right.avi", ticks(0, 24));
  for (const std::string name : {"jpeg.avi", "jpeg.mkv", "ffv1.mkv", "ffv1.avi"}) {
    SCOPED_TRACE(name);
    const bool jpeg = name.starts_with("jpeg");
    write_video_at(dir / name, jpeg ? AV_CODEC_ID_MJPEG : AV_CODEC_ID_FFV1, jpeg ? AV_PIX_FMT_YUVJ420P : AV_PIX_FMT_GRAY8,
                   ticks(0, 24), {.key_every = 1});
    spoil(dir / name, 13);
    const PairsRead read = read_pairs(dir / name, dir / "right.avi");
    ASSERT_EQ(read.shown.size(), 23u) << read.error;
    for (const auto& [l, r] : read.shown) EXPECT_TRUE(l == r && l != 13) << l << ' ' << r;
    EXPECT_EQ(read.end, Next::kEnd);
    EXPECT_NE(read.warning.find("1 picture of " + (dir / name).string() + " is damaged: left out"), std::string::npos)
        << read.warning;
  }
  // Pictures coded by others: all up to the next one that is not.
  write_video_at(dir / "p.avi", AV_CODEC_ID_MPEG4, AV_PIX_FMT_YUV420P, ticks(0, 24), {.key_every = 6});
  const PairsRead whole = read_pairs(dir / "p.avi", dir / "right.avi");
  ASSERT_EQ(whole.shown.size(), 24u);
  spoil(dir / "p.avi", 8);
  const PairsRead read = read_pairs(dir / "p.avi", dir / "right.avi");
  for (const auto& [l, r] : read.shown) EXPECT_TRUE(l == r && (l < 8 || l >= 12)) << l << ' ' << r;
  EXPECT_EQ(read.shown.size(), 20u) << read.error;
  EXPECT_EQ(read.end, Next::kEnd);
}

TEST(FilePairs, JpegsOneAfterTheOtherAreAVideo) {
  const TempFolder dir;
  auto encoder = make_encoder(AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P);
  std::string plain, parts;
  for (int t = 0; t < 8; ++t)
    encoder.encode(pattern(AV_PIX_FMT_YUVJ420P, t).get(), [&](AVPacket& p) {
      const std::string jpeg(reinterpret_cast<char*>(p.data), static_cast<std::size_t>(p.size));
      plain += jpeg;
      parts +=
          "--cut\r\nContent-Type: image/jpeg\r\nContent-Length: " + std::to_string(jpeg.size()) + "\r\n\r\n" + jpeg + "\r\n";
    });
  put(dir / "plain.mjpeg", plain);
  put(dir / "parts.mjpeg", parts);
  for (const char* name : {"plain.mjpeg", "parts.mjpeg"}) {
    SCOPED_TRACE(name);
    const PairsRead read = read_pairs(dir / name, dir / name);
    ASSERT_EQ(read.shown.size(), 8u) << read.error;
    for (int t = 0; t < 8; ++t) EXPECT_EQ(read.shown[static_cast<std::size_t>(t)], std::pair(t, t));
    EXPECT_EQ(read.end, Next::kEnd) << read.warning;
  }
  put(dir / "cut.mjpeg", std::string_view(plain).substr(0, plain.size() - 300));
  const PairsRead cut = read_pairs(dir / "cut.mjpeg", dir / "plain.mjpeg");
  EXPECT_EQ(cut.shown.size(), 7u) << cut.error;
  EXPECT_EQ(cut.end, Next::kCut);
}

/// A texture of which each place is told from others, seen `shift` pixels further right.
Image<Rgb8> texture(Size size, int shift, unsigned seed) {
  Image<Rgb8> out(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      unsigned h = (static_cast<unsigned>(x + shift) / 3 * 2654435761u) ^ (static_cast<unsigned>(y) / 3 * 40503u) ^ seed;
      h = (h ^ h >> 15) * 2246822519u;
      const auto v = static_cast<std::uint8_t>(h >> 24);
      out.at(y, x) = {v, v, v};
    }
  return out;
}

void write_ppm(const std::filesystem::path& path, const Image<Rgb8>& picture) {
  std::string bytes = "P6\n" + std::to_string(picture.width()) + " " + std::to_string(picture.height()) + "\n255\n";
  for (int y = 0; y < picture.height(); ++y)
    bytes.append(reinterpret_cast<const char*>(picture.row(y)), 3 * static_cast<std::size_t>(picture.width()));
  put(path, bytes);
}

TEST(OneFile, HalvesWhereTheyAreAndOnlyOfTwoViews) {
  constexpr Size kView{160, 120};
  const TempFolder dir;
  const Image<Rgb8> left = texture(kView, 0, 1), right = texture(kView, 6, 1), other = texture(kView, 0, 99);
  const auto join = [&](const Image<Rgb8>& a, const Image<Rgb8>& b, bool above) {
    Image<Rgb8> both(above ? Size{kView.width, 2 * kView.height} : Size{2 * kView.width, kView.height});
    for (int y = 0; y < kView.height; ++y) {
      std::copy_n(a.row(y), kView.width, both.row(y));
      std::copy_n(b.row(y), kView.width, above ? both.row(y + kView.height) : both.row(y) + kView.width);
    }
    return both;
  };
  const auto expect_views = [&](const std::string& name, std::optional<ViewLayout> layout) {
    auto pairs = open_pairs(dir / name, {}, {.layout = layout});
    ASSERT_TRUE(pairs) << pairs.error().what;
    Pair pair;
    const auto next = (*pairs)->next(pair);
    ASSERT_TRUE(next) << next.error().what;
    ASSERT_EQ(pair.left.pixels.size(), kView);
    for (int y = 0; y < kView.height; y += 7)
      for (int x = 0; x < kView.width; ++x) {
        ASSERT_EQ(pair.left.pixels.at(y, x), left.at(y, x));
        ASSERT_EQ(pair.right.pixels.at(y, x), right.at(y, x));
      }
  };
  write_ppm(dir / "beside.ppm", join(left, right, false));
  write_ppm(dir / "crossed.ppm", join(right, left, false));
  write_ppm(dir / "above.ppm", join(left, right, true));
  write_ppm(dir / "below.ppm", join(right, left, true));
  expect_views("beside.ppm", std::nullopt);
  expect_views("beside.ppm", ViewLayout::kSideBySide);
  expect_views("crossed.ppm", ViewLayout::kRightLeft);
  expect_views("above.ppm", ViewLayout::kTopBottom);
  expect_views("below.ppm", ViewLayout::kBottomTop);
  write_ppm(dir / "one.ppm", join(left, other, false));
  const PairsRead one = read_pairs(dir / "one.ppm", {});
  EXPECT_NE(one.error.find("its halves have nothing in common"), std::string::npos) << one.error;
  EXPECT_FALSE(open_pairs(dir / "beside.ppm", dir / "beside.ppm", {.layout = ViewLayout::kSideBySide}));
  EXPECT_FALSE(open_pairs(dir / "beside.ppm", {}, {.skew_ns = 1'000'000}));
}

TEST(OneFile, AVideoSaysItsLayoutAndHowItIsHeld) {
  const TempFolder dir;
  const auto first_of = [&](const std::string& name) {
    auto pairs = open_pairs(dir / name, {});
    EXPECT_TRUE(pairs) << pairs.error().what;
    Pair pair;
    EXPECT_TRUE(pairs && (*pairs)->next(pair));
    return pair;
  };
  const av::DecodedFrame whole = pattern(AV_PIX_FMT_GRAY8, 0);
  const auto at = [&](int y, int x) { return whole->data[0][y * whole->linesize[0] + x]; };
  const auto stereo = [](const char* mode) {
    return VideoStyle{.stream = [mode](AVStream& s) { av_dict_set(&s.metadata, "stereo_mode", mode, 0); }};
  };
  write_gray(dir / "rl.mkv", ticks(0, 3), stereo("right_left"));
  Pair pair = first_of("rl.mkv");
  EXPECT_EQ(pair.left.pixels.size(), (Size{kSize.width / 2, kSize.height}));
  EXPECT_EQ(pair.left.pixels.at(5, 3).g, at(5, 3 + kSize.width / 2));
  EXPECT_EQ(pair.right.pixels.at(5, 3).g, at(5, 3));
  write_gray(dir / "tb.mkv", ticks(0, 3), stereo("top_bottom"));
  pair = first_of("tb.mkv");
  EXPECT_EQ(pair.left.pixels.size(), (Size{kSize.width, kSize.height / 2}));
  EXPECT_EQ(pair.right.pixels.at(5, 3).g, at(5 + kSize.height / 2, 3));
  write_gray(dir / "turns.mkv", ticks(0, 3), stereo("block_lr"));
  EXPECT_FALSE(open_pairs(dir / "turns.mkv", {}));

  const auto held = [](int degrees) {
    return VideoStyle{.stream = [degrees](AVStream& s) {
      const auto turn = [&](int d) -> std::array<std::int32_t, 9> {
        constexpr std::int32_t kOne = 1 << 16, kUnit = 1 << 30;
        if (d == 90) return {0, kOne, 0, -kOne, 0, 0, 0, 0, kUnit};
        if (d == 180) return {-kOne, 0, 0, 0, -kOne, 0, 0, 0, kUnit};
        return {0, -kOne, 0, kOne, 0, 0, 0, 0, kUnit};
      };
      const std::array<std::int32_t, 9> matrix = turn(degrees);
      std::memcpy(av_stream_new_side_data(&s, AV_PKT_DATA_DISPLAYMATRIX, sizeof matrix), matrix.data(), sizeof matrix);
    }};
  };
  write_gray(dir / "stored.mp4", ticks(0, 3));
  Picture as_stored;
  ASSERT_TRUE((*open_source(dir / "stored.mp4"))->next(as_stored));
  for (const int degrees : {90, 180, 270}) {
    SCOPED_TRACE(degrees);
    write_gray(dir / "held.mp4", ticks(0, 3), held(degrees));
    auto source = open_source(dir / "held.mp4");
    ASSERT_TRUE(source) << source.error().what;
    Picture picture;
    ASSERT_TRUE((*source)->next(picture));
    const Size size = picture.pixels.size();
    EXPECT_EQ(size, (*source)->size());
    EXPECT_EQ(size, degrees == 180 ? kSize : (Size{kSize.height, kSize.width}));
    EXPECT_TRUE(picture.jpeg.empty());  // its bytes are of the turned one
    int wrong = 0;
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const int v = degrees == 90 ? kSize.height - 1 - x : degrees == 180 ? kSize.height - 1 - y : x;
        const int u = degrees == 90 ? y : degrees == 180 ? kSize.width - 1 - x : kSize.width - 1 - y;
        wrong += picture.pixels.at(y, x) != as_stored.pixels.at(v, u);
      }
    EXPECT_EQ(wrong, 0);
  }
}

}  // namespace
}  // namespace duo
