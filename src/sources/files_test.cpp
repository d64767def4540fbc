// Files written here with libav's encoders are read back whole, then cut at many bytes: a cut picture is an error, a cut
// video gives exactly its first whole pictures and says that it was cut, or is an error when none is left.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "duoptic/source.h"
#include "sources/packet_check.h"
#include "tests/write_media.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using namespace test;  // NOLINT: the writers of tests/write_media.h

struct Read {
  bool opened = false;
  Next end = Next::kNew;
  std::vector<std::vector<Rgb8>> pictures;
  std::string error;
};

Read read_all(const fs::path& path) {
  Read out;
  auto source = open_source(path);
  if (!source) {
    out.error = source.error().what;
    return out;
  }
  out.opened = true;
  Picture picture;
  while (true) {
    const auto next = (*source)->next(picture);
    if (!next) {
      out.error = next.error().what;
      return out;
    }
    out.end = *next;
    if (*next != Next::kNew) return out;
    auto& pixels = out.pictures.emplace_back();
    for (int y = 0; y < picture.pixels.height(); ++y)
      pixels.insert(pixels.end(), picture.pixels.row(y), picture.pixels.row(y) + picture.pixels.width());
  }
}

struct PictureCase {
  const char* name;
  AVCodecID codec;
  AVPixelFormat format;
};
const PictureCase kPictures[] = {
    {"rgb.png", AV_CODEC_ID_PNG, AV_PIX_FMT_RGB24},     {"gray.png", AV_CODEC_ID_PNG, AV_PIX_FMT_GRAY8},
    {"rgba.png", AV_CODEC_ID_PNG, AV_PIX_FMT_RGBA},     {"gray16.png", AV_CODEC_ID_PNG, AV_PIX_FMT_GRAY16BE},
    {"rgb48.png", AV_CODEC_ID_PNG, AV_PIX_FMT_RGB48BE}, {"yuv.jpg", AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P},
    {"rgb.bmp", AV_CODEC_ID_BMP, AV_PIX_FMT_BGR24},     {"rgb.tif", AV_CODEC_ID_TIFF, AV_PIX_FMT_RGB24},
    {"rgb.ppm", AV_CODEC_ID_PPM, AV_PIX_FMT_RGB24},     {"gray.pgm", AV_CODEC_ID_PGM, AV_PIX_FMT_GRAY8},
};

std::uint8_t byte_at(const AVFrame& frame, int y, int offset) { return frame.data[0][y * frame.linesize[0] + offset]; }

TEST(Pictures, EveryKindIsReadWithItsValues) {
  const TempFolder dir;
  for (const PictureCase& c : kPictures) {
    SCOPED_TRACE(c.name);
    write_picture(dir / c.name, c.codec, c.format);
    const Read read = read_all(dir / c.name);
    ASSERT_TRUE(read.opened) << read.error;
    ASSERT_EQ(read.pictures.size(), 1u);
    EXPECT_EQ(read.end, Next::kEnd);
    if (c.codec == AV_CODEC_ID_MJPEG) continue;  // lossy
    const av::DecodedFrame truth = pattern(c.format, 0);
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        const Rgb8 got = read.pictures[0][static_cast<std::size_t>(y * kSize.width + x)];
        const auto at = [&](int offset) { return byte_at(*truth, y, offset); };
        switch (c.format) {
          case AV_PIX_FMT_RGB24:
            ASSERT_EQ(got, (Rgb8{at(3 * x), at(3 * x + 1), at(3 * x + 2)})) << y << ' ' << x;
            break;
          case AV_PIX_FMT_BGR24:
            ASSERT_EQ(got, (Rgb8{at(3 * x + 2), at(3 * x + 1), at(3 * x)})) << y << ' ' << x;
            break;
          case AV_PIX_FMT_RGBA:
            ASSERT_EQ(got, (Rgb8{at(4 * x), at(4 * x + 1), at(4 * x + 2)})) << y << ' ' << x;
            break;
          case AV_PIX_FMT_GRAY8:
            ASSERT_EQ(got, (Rgb8{at(x), at(x), at(x)})) << y << ' ' << x;
            break;
          case AV_PIX_FMT_GRAY16BE:
            ASSERT_EQ(got, (Rgb8{at(2 * x), at(2 * x), at(2 * x)})) << y << ' ' << x;
            break;
          default:
            ASSERT_NEAR(got.g, at(6 * x + 2), 1) << y << ' ' << x;
        }
      }
  }
}

TEST(Pictures, CutAnywhereIsAnError) {
  const TempFolder dir;
  for (const PictureCase& c : kPictures) {
    SCOPED_TRACE(c.name);
    write_picture(dir / c.name, c.codec, c.format);
    const std::string whole = bytes_of(dir / c.name);
    for (int i = 1; i < 40; ++i) {
      const std::size_t keep = whole.size() * static_cast<std::size_t>(i) / 40;
      put(dir / "cut", std::string_view(whole).substr(0, keep));
      const Read read = read_all(dir / "cut");
      EXPECT_FALSE(read.opened) << keep << " of " << whole.size() << " bytes";
      EXPECT_EQ(read.error.find('\n'), std::string::npos);
    }
  }
}

struct VideoCase {
  const char* name;
  AVCodecID codec;
  AVPixelFormat format;
  int b_frames;
  const char* movflags;
};
const VideoCase kVideos[] = {
    {"mjpeg.avi", AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, 0, nullptr},
    {"mjpeg.mkv", AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, 0, nullptr},
    {"mpeg4.avi", AV_CODEC_ID_MPEG4, AV_PIX_FMT_YUV420P, 0, nullptr},
    {"b_frames.mkv", AV_CODEC_ID_MPEG4, AV_PIX_FMT_YUV420P, 2, nullptr},
    {"index_last.mp4", AV_CODEC_ID_MPEG4, AV_PIX_FMT_YUV420P, 2, nullptr},
    {"index_first.mp4", AV_CODEC_ID_MPEG4, AV_PIX_FMT_YUV420P, 2, "faststart"},
};

TEST(Videos, EveryPictureOnce) {
  const TempFolder dir;
  for (const VideoCase& c : kVideos) {
    SCOPED_TRACE(c.name);
    write_video(dir / c.name, c.codec, c.format, c.b_frames, c.movflags);
    const Read read = read_all(dir / c.name);
    ASSERT_TRUE(read.opened) << read.error;
    EXPECT_EQ(read.pictures.size(), static_cast<std::size_t>(kFrames));
    EXPECT_EQ(read.end, Next::kEnd);
    for (std::size_t i = 1; i < read.pictures.size(); ++i) EXPECT_NE(read.pictures[i], read.pictures[i - 1]) << i;
  }
}

TEST(Videos, CutGivesItsWholePicturesAndSaysSo) {
  const TempFolder dir;
  for (const VideoCase& c : kVideos) {
    SCOPED_TRACE(c.name);
    write_video(dir / c.name, c.codec, c.format, c.b_frames, c.movflags);
    const std::string bytes = bytes_of(dir / c.name);
    const Read whole = read_all(dir / c.name);
    std::size_t cuts_seen = 0;
    for (std::size_t keep = 1; keep < bytes.size(); keep += bytes.size() / 97 + 1) {
      put(dir / "cut", std::string_view(bytes).substr(0, keep));
      const Read read = read_all(dir / "cut");
      if (!read.opened) continue;
      ASSERT_LE(read.pictures.size(), whole.pictures.size()) << keep;
      for (std::size_t i = 0; i < read.pictures.size(); ++i)
        ASSERT_EQ(read.pictures[i], whole.pictures[i]) << keep << " bytes, picture " << i;
      if (read.pictures.size() < whole.pictures.size()) {
        EXPECT_EQ(read.end, Next::kCut) << keep << " bytes, " << read.pictures.size() << " pictures";
        ++cuts_seen;
      }
    }
    // Without its index, which comes last, an MP4 cannot be read at all.
    if (std::string(c.name) == "index_last.mp4")
      EXPECT_EQ(cuts_seen, 0u);
    else
      EXPECT_GE(cuts_seen, 20u);
  }
}

TEST(Videos, AHoleOfZerosIsDamageWhateverADecoderMakesOfIt) {
  std::vector<std::uint8_t> bytes(1000, 7);
  AVPacket packet{};
  packet.data = bytes.data();
  packet.size = static_cast<int>(bytes.size());
  for (const int begin : {0, 1, 255, 256, 700, 744}) {
    std::fill(bytes.begin(), bytes.end(), std::uint8_t{7});
    std::fill_n(bytes.begin() + begin, 255, std::uint8_t{0});
    EXPECT_FALSE(has_hole(packet, AV_CODEC_ID_HEVC)) << begin;
    bytes[static_cast<std::size_t>(begin) + 255] = 0;
    for (const AVCodecID codec : {AV_CODEC_ID_HEVC, AV_CODEC_ID_VP9}) EXPECT_TRUE(has_hole(packet, codec)) << begin;
    for (const AVCodecID codec : {AV_CODEC_ID_RAWVIDEO, AV_CODEC_ID_FFV1}) EXPECT_FALSE(has_hole(packet, codec)) << begin;
  }
  packet.size = 0;
  EXPECT_FALSE(has_hole(packet, AV_CODEC_ID_HEVC));
}

TEST(Files, WhatCannotBeUsedIsOneClearLine) {
  const TempFolder dir;
  put(dir / "empty.png", "");
  put(dir / "text.txt", "not a picture at all, only words that go on for a while\n");
  put(dir / "list.m3u8", "#EXTM3U\n#EXTINF:1,\n/etc/hostname\n");
  for (const char* name : {"missing.png", "empty.png", "text.txt", "list.m3u8", "."}) {
    const Read read = read_all(dir / name);
    EXPECT_FALSE(read.opened) << name;
    EXPECT_NE(read.error.find(name), std::string::npos) << read.error;
    EXPECT_EQ(read.error.find('\n'), std::string::npos) << read.error;
  }
}

TEST(Pairs, SideBySideAndRefusals) {
  const TempFolder dir;
  write_picture(dir / "a.png", AV_CODEC_ID_PNG, AV_PIX_FMT_RGB24);
  write_video(dir / "v.avi", AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, 0);
  auto both = open_pairs(dir / "a.png", {});
  ASSERT_TRUE(both);
  EXPECT_EQ((*both)->size(), (Size{kSize.width / 2, kSize.height}));
  Pair pair;
  ASSERT_TRUE((*both)->next(pair));
  const auto whole = read_all(dir / "a.png").pictures[0];
  EXPECT_EQ(pair.left.pixels.at(5, 3), whole[5 * kSize.width + 3]);
  EXPECT_EQ(pair.right.pixels.at(5, 3), whole[5 * kSize.width + 3 + kSize.width / 2]);
  EXPECT_FALSE(open_pairs(dir / "a.png", dir / "v.avi"));
  put(dir / "small.pgm", "P5\n3 2\n255\n......");
  EXPECT_FALSE(open_pairs(dir / "a.png", dir / "small.pgm"));
  EXPECT_FALSE(open_pairs(dir / "small.pgm", {}));
}

TEST(Pairs, CutAndShorterFilesAreNamed) {
  const TempFolder dir;
  write_video(dir / "v.avi", AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, 0);
  const std::string bytes = bytes_of(dir / "v.avi");
  put(dir / "cut.avi", std::string_view(bytes).substr(0, bytes.size() / 2));
  auto pairs = open_pairs(dir / "v.avi", dir / "cut.avi");
  ASSERT_TRUE(pairs);
  Pair pair;
  int given = 0;
  auto next = (*pairs)->next(pair);
  for (; next && *next == Next::kNew; next = (*pairs)->next(pair)) ++given;
  ASSERT_TRUE(next);
  EXPECT_EQ(*next, Next::kCut);
  EXPECT_GT(given, 0);
  EXPECT_LT(given, kFrames);
  EXPECT_NE((*pairs)->warning().find("cut.avi"), std::string::npos) << (*pairs)->warning();
}

/// The most memory that this process ever had, in MB; of a fork it is that one's own.
long most_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

/// A PNG of black pixels, one bit each: few bytes, many pixels.
void write_black(const fs::path& path, Size size) {
  Encoder encoder = make_encoder(AV_CODEC_ID_PNG, AV_PIX_FMT_MONOBLACK);
  encoder.context.reset(avcodec_alloc_context3(avcodec_find_encoder(AV_CODEC_ID_PNG)));
  encoder.context->width = size.width;
  encoder.context->height = size.height;
  encoder.context->pix_fmt = AV_PIX_FMT_MONOBLACK;
  encoder.context->time_base = {1, 1};
  ASSERT_GE(avcodec_open2(encoder.context.get(), nullptr, nullptr), 0);
  const av::DecodedFrame frame(av_frame_alloc());
  frame->format = AV_PIX_FMT_MONOBLACK;
  frame->width = size.width;
  frame->height = size.height;
  ASSERT_GE(av_frame_get_buffer(frame.get(), 0), 0);
  std::memset(frame->data[0], 0, static_cast<std::size_t>(frame->linesize[0]) * static_cast<std::size_t>(size.height));
  encoder.encode(frame.get(), [&](AVPacket& p) {
    put(path, {reinterpret_cast<char*>(p.data), static_cast<std::size_t>(p.size)});
  });
}

TEST(Limits, TooManyPixelsAreRefusedBeforeTheyAreDecoded) {
  const TempFolder folder;
  write_black(folder / "large.png", {16000, 16000});
  write_black(folder / "larger.png", {8200, 8200});  // little more than may be
  ASSERT_LT(fs::file_size(folder / "large.png"), 500'000u);
  const long before_mb = most_memory_mb();
  for (int i = 0; i < 2; ++i) {
    const std::string error = i == 0 ? read_all(folder / "large.png").error : read_png16(folder / "large.png").error().what;
    EXPECT_NE(error.find("more than the 67.1 million pixels"), std::string::npos) << error;
    EXPECT_NE(error.find("--max-megapixels"), std::string::npos) << error;
  }
  EXPECT_LT(most_memory_mb(), before_mb + 100);  // decoded it has 256 MB and more
  EXPECT_NE(read_all(folder / "larger.png").error.find("8200x8200 pixels, more than"), std::string::npos);
}

TEST(Limits, TheMostPixelsAreTheCallersChoice) {
  const TempFolder folder;
  for (const PictureCase& picture : kPictures) write_picture(folder / picture.name, picture.codec, picture.format);
  write_video(folder / "v.mp4", AV_CODEC_ID_MPEG4, AV_PIX_FMT_YUV420P, 0);
  write_video(folder / "v.avi", AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, 0);
  constexpr std::int64_t kPixels = std::int64_t{kSize.width} * kSize.height;
  for (const auto& entry : fs::directory_iterator(folder / "")) {
    limit_pictures(kPixels);
    EXPECT_TRUE(read_all(entry.path()).opened) << entry.path();
    limit_pictures(kPixels / 2);
    EXPECT_FALSE(read_all(entry.path()).opened) << entry.path();
  }
  limit_pictures(kMostPixels);
}

TEST(Limits, AFilesSizeIsLookedAtBeforeItIsRead) {
  const TempFolder folder;
  put(folder / "large.bmp", "BM");
  fs::resize_file(folder / "large.bmp", std::uintmax_t{40} << 30);  // holes: takes no room
  const long before_mb = most_memory_mb();
  const Read read = read_all(folder / "large.bmp");
  EXPECT_NE(read.error.find("more than 1073741824 bytes"), std::string::npos) << read.error;
  EXPECT_LT(most_memory_mb(), before_mb + 100);
}

}  // namespace
}  // namespace duo
