// Pictures as people have them: held upright, two in a file, of ten bits, of kinds that are not read.
#include "sources/picture_bytes.h"

#include <gtest/gtest.h>

#include "core/coded_picture.h"
#include "tests/write_media.h"

namespace duo {
namespace {

using namespace std::string_literals;
using namespace std::string_view_literals;
using namespace test;  // NOLINT: the writers of tests/write_media.h

std::string big(unsigned value, int bytes) {
  std::string out;
  for (int i = bytes - 1; i >= 0; --i) out += static_cast<char>(value >> 8 * i);
  return out;
}

/// An EXIF block with nothing but an orientation, big-endian.
std::string exif(unsigned orientation) {
  return "MM\0*"s + big(8, 4) + big(1, 2) + big(274, 2) + big(3, 2) + big(1, 4) + big(orientation, 2) + big(0, 2) + big(0, 4);
}

std::string coded(AVCodecID codec, AVPixelFormat format, int t = 0) {
  std::string out;
  make_encoder(codec, format).encode(pattern(format, t).get(), [&](AVPacket& p) {
    out.assign(reinterpret_cast<char*>(p.data), static_cast<std::size_t>(p.size));
  });
  return out;
}

std::string jpeg_with(std::uint8_t marker, const std::string& content, int t = 0) {
  std::string jpeg = coded(AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, t);
  return jpeg.insert(2, "\xff"s + static_cast<char>(marker) + big(static_cast<unsigned>(content.size()) + 2, 2) + content);
}

std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t crc = ~0u;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

Image<Rgb8> read(const std::filesystem::path& path) {
  auto source = open_source(path);
  EXPECT_TRUE(source) << source.error().what;
  Picture picture;
  if (!source) return {};
  EXPECT_TRUE((*source)->next(picture));
  EXPECT_EQ(picture.pixels.size(), (*source)->size());
  return std::move(picture.pixels);
}

// Ten steps of 16: 16 sqrt(10 * 256 / 768) = 29.2. Of the others, and of the colours, none counts.
TEST(CodingNoise, ByHand) {
  const auto tables = [](const std::string& content) {
    return "\xff\xd8\xff\xdb"s + big(static_cast<unsigned>(content.size()) + 2, 2) + content;
  };
  const std::string steps = std::string(10, '\x10') + std::string(54, '\xc8'), fine(64, '\x01');
  EXPECT_EQ(coding_noise_q4(tables("\0"s + steps)), 29);
  EXPECT_EQ(coding_noise_q4(tables("\0"s + steps + "\1"s + fine)), 29);
  EXPECT_EQ(coding_noise_q4(tables("\1"s + fine + "\0"s + steps)), 29);
  EXPECT_EQ(coding_noise_q4(tables("\1"s + steps)), 0);
  // A frame of 8 bits, 16x16, whose first component has table 2, the second table 0.
  const std::string frame = "\xff\xc0\x00\x0e\x08\x00\x10\x00\x10\x02\x01\x11\x02\x02\x11\x00"s;
  EXPECT_EQ(coding_noise_q4(tables("\0"s + fine + "\2"s + steps) + frame), 29);
  EXPECT_EQ(coding_noise_q4(tables("\0"s + steps + "\2"s + fine) + frame), 2);
  EXPECT_EQ(coding_noise_q4(tables("\0"s + fine)), 2);  // 16 sqrt(10 / 768) = 1.8
  std::string wide = "\x10"s;
  for (int i = 0; i < 64; ++i) wide += big(300, 2);  // 16 sqrt(10 * 90000 / 768) = 547.7
  EXPECT_EQ(coding_noise_q4(tables(wide)), 548);
  EXPECT_EQ(coding_noise_q4(tables("\0"s + steps).substr(0, 40)), 0);
  EXPECT_EQ(coding_noise_q4(tables("\0"s + steps.substr(1))), 0);
  EXPECT_EQ(coding_noise_q4("\x89PNG"), 0);
  EXPECT_EQ(coding_noise_q4(""), 0);
}

TEST(CodingNoise, ComesWithThePicture) {
  const TempFolder dir;
  Image<Rgb8> gray({32, 32});
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) gray.at(y, x) = {128, 128, 128};
  const std::string half = jpeg_of(gray.view(), 50);  // 16 11 12 14 12 10 16 14 13 14: 16 sqrt(1778 / 768) = 24.3
  put(dir / "half.jpg", half);
  put(dir / "half.mjpeg", half + half);
  put(dir / "whole.png", png_of(View<const Rgb8>(gray.view())));
  for (const auto& [name, noise_q4] : {std::pair("half.jpg", 24), {"half.mjpeg", 24}, {"whole.png", 0}}) {
    const auto source = open_source(dir / name);
    ASSERT_TRUE(source) << source.error().what;
    Picture picture;
    picture.coding_noise_q4 = 7;
    ASSERT_TRUE((*source)->next(picture));
    EXPECT_EQ(picture.coding_noise_q4, noise_q4) << name;
  }
}

TEST(Orientation, EachOfEightByHand) {
  // a b c
  // d e f
  const char* kShown[] = {"abc/def", "cba/fed", "fed/cba", "def/abc", "ad/be/cf", "da/eb/fc", "fc/eb/da", "cf/be/ad"};
  for (unsigned exif_value = 1; exif_value <= 8; ++exif_value) {
    Image<Rgb8> picture({3, 2}), memory;
    for (int i = 0; i < 6; ++i) picture.at(i / 3, i % 3).g = static_cast<std::uint8_t>('a' + i);
    const Orientation orientation = orientation_of_exif(exif_value);
    put_upright(picture, orientation, memory);
    EXPECT_EQ(picture.size(), upright({3, 2}, orientation));
    std::string shown;
    for (int y = 0; y < picture.height(); ++y) {
      if (y > 0) shown += '/';
      for (int x = 0; x < picture.width(); ++x) shown += static_cast<char>(picture.at(y, x).g);
    }
    EXPECT_EQ(shown, kShown[exif_value - 1]) << exif_value;
  }
  EXPECT_EQ(orientation_of_exif(0), Orientation::kTopLeft);
  EXPECT_EQ(orientation_of_exif(9), Orientation::kTopLeft);
}

TEST(Orientation, PicturesComeUpright) {
  const TempFolder dir;
  put(dir / "plain.jpg", coded(AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P));
  put(dir / "plain.png", coded(AV_CODEC_ID_PNG, AV_PIX_FMT_RGB24));
  for (const unsigned value : {1u, 3u, 6u, 8u, 5u}) {
    const std::string block = exif(value);
    put(dir / "turned.jpg", jpeg_with(0xe1, "Exif\0\0"s + block));
    std::string png = coded(AV_CODEC_ID_PNG, AV_PIX_FMT_RGB24);
    const std::string chunk = "eXIf" + block;
    png.insert(png.find("IDAT") - 4, big(static_cast<unsigned>(block.size()), 4) + chunk + big(crc32(chunk), 4));
    put(dir / "turned.png", png);
    for (const std::string kind : {".jpg", ".png"}) {
      Image<Rgb8> expected = read(dir / ("plain" + kind)), memory;
      put_upright(expected, orientation_of_exif(value), memory);
      const Image<Rgb8> turned = read(dir / ("turned" + kind));
      ASSERT_EQ(turned.size(), expected.size()) << kind << value;
      for (int y = 0; y < turned.height(); ++y)
        for (int x = 0; x < turned.width(); ++x) ASSERT_EQ(turned.at(y, x), expected.at(y, x)) << kind << value;
    }
  }
}

/// An MPO of these pictures, of these kinds; the index lies in the first one.
std::string mpo(const std::vector<unsigned>& kinds) {
  const auto count = static_cast<unsigned>(kinds.size());
  const auto index = [&](const std::vector<std::string>& pictures, std::size_t block_at) {
    std::string out = "MPF\0"s + "MM\0*"s + big(8, 4) + big(2, 2);
    out += big(0xb001, 2) + big(4, 2) + big(1, 4) + big(count, 4);
    out += big(0xb002, 2) + big(7, 2) + big(16 * count, 4) + big(38, 4) + big(0, 4);
    std::size_t at = 0;
    for (unsigned i = 0; i < count; ++i) {
      const std::size_t size = pictures.empty() ? 0 : pictures[i].size();
      out += big(kinds[i], 4) + big(static_cast<unsigned>(size), 4) +
             big(i == 0 ? 0 : static_cast<unsigned>(at - block_at), 4) + big(0, 4);
      at += size;
    }
    return out;
  };
  std::vector<std::string> pictures;
  for (unsigned i = 0; i < count; ++i)
    pictures.push_back(coded(AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, 3 * static_cast<int>(i)));
  pictures[0] = jpeg_with(0xe2, index({}, 0));
  constexpr std::size_t kBlock = 2 + 4 + 4;  // after start, marker with length, and "MPF\0"
  pictures[0] = jpeg_with(0xe2, index(pictures, kBlock));
  std::string all;
  for (const std::string& picture : pictures) all += picture;
  return all;
}

TEST(Mpo, TwoViewsAndNoPreviews) {
  const TempFolder dir;
  for (const auto& kinds : {std::vector<unsigned>{0x20020002, 0x00020002}, {0x00030000, 0}}) {
    put(dir / "both.mpo", mpo(kinds));
    auto pairs = open_pairs(dir / "both.mpo", {});
    ASSERT_TRUE(pairs) << pairs.error().what;
    EXPECT_TRUE((*pairs)->still());
    Pair pair;
    ASSERT_TRUE((*pairs)->next(pair));
    ASSERT_EQ(pair.left.pixels.size(), kSize);
    put(dir / "right.jpg", coded(AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, 3));
    EXPECT_EQ(pair.right.pixels.at(20, 20), read(dir / "right.jpg").at(20, 20));
  }
  EXPECT_EQ(views_of_mpo(mpo({0x20030000, 0x00010001})).size(), 0u);              // a preview
  EXPECT_EQ(views_of_mpo(mpo({0x20030000, 0x00010001, 0x00020002})).size(), 2u);  // and a view
  EXPECT_EQ(views_of_mpo(mpo({0x00030000, 0}) + "hdrgm").size(), 0u);             // a gain map
  EXPECT_FALSE(is_jpeg_sequence(mpo({0x20030000, 0x00010001})));
  const std::string jpeg = coded(AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P);
  EXPECT_EQ(jpeg_length(jpeg), jpeg.size());
  EXPECT_EQ(jpeg_length(jpeg + "more"), jpeg.size());
  EXPECT_TRUE(is_jpeg_sequence(jpeg + std::string(7, '\0') + jpeg));
  EXPECT_FALSE(is_jpeg_sequence(jpeg + "\0\0ftypmp42"s));  // a motion photo
  for (std::size_t i = 0; i < jpeg.size(); i += 13) EXPECT_EQ(jpeg_length(jpeg.substr(0, i)), std::string::npos);
}

TEST(Jps, ItsMarkerSaysTheLayoutElseTheRightViewComesFirst) {
  const auto jps = [](unsigned descriptor) { return jpeg_with(0xe3, "_JPSJPS_"s + big(4, 2) + big(descriptor, 4)); };
  EXPECT_EQ(layout_of_jps(jps(0x00040201), false), ViewLayout::kSideBySide);
  EXPECT_EQ(layout_of_jps(jps(0x00000201), false), ViewLayout::kRightLeft);
  EXPECT_EQ(layout_of_jps(jps(0x00040301), false), ViewLayout::kTopBottom);
  EXPECT_EQ(layout_of_jps(jps(0x00000301), false), ViewLayout::kBottomTop);
  const std::string plain = coded(AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P);
  EXPECT_EQ(layout_of_jps(plain, true), ViewLayout::kRightLeft);
  EXPECT_EQ(layout_of_jps(plain, false), std::nullopt);
}

/// Gray of 16 bits: `value(x)` in every row.
template <class Value>
void write_gray16(const std::filesystem::path& path, AVCodecID codec, Value&& value) {
  const AVPixelFormat format = codec == AV_CODEC_ID_PNG ? AV_PIX_FMT_GRAY16BE : AV_PIX_FMT_GRAY16LE;
  Encoder encoder = make_encoder(codec, format);
  const av::DecodedFrame frame = pattern(format, 0);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const auto v = static_cast<unsigned>(value(x));
      std::uint8_t* p = frame->data[0] + y * frame->linesize[0] + 2 * x;
      p[format == AV_PIX_FMT_GRAY16BE] = static_cast<std::uint8_t>(v);
      p[format != AV_PIX_FMT_GRAY16BE] = static_cast<std::uint8_t>(v >> 8);
    }
  encoder.encode(frame.get(), [&](AVPacket& p) {
    put(path, {reinterpret_cast<char*>(p.data), static_cast<std::size_t>(p.size)});
  });
}

TEST(Gray16, BothPicturesAreScaledByWhatBothUse) {
  const TempFolder dir;
  const auto levels = [&](const char* left, const char* right, int x) {
    auto pairs = open_pairs(dir / left, dir / right);
    EXPECT_TRUE(pairs) << pairs.error().what;
    Pair pair;
    EXPECT_TRUE(pairs && (*pairs)->next(pair));
    return std::pair<int, int>(pair.left.pixels.at(9, x).g, pair.right.pixels.at(9, x).g);
  };
  for (const AVCodecID codec : {AV_CODEC_ID_PNG, AV_CODEC_ID_TIFF}) {
    write_gray16(dir / "ten", codec, [](int x) { return 16 * x; });           // up to 1008
    write_gray16(dir / "dim", codec, [](int x) { return 4 * x; });            // of the same camera, up to 252
    write_gray16(dir / "twelve", codec, [](int x) { return 64 * x + 30; });   // up to 4062
    write_gray16(dir / "all", codec, [](int x) { return 1024 * x + 1; });     // up to 64513
    write_gray16(dir / "warm", codec, [](int x) { return 29000 + 16 * x; });  // a thermal camera
    write_gray16(dir / "eight", codec, [](int x) { return 4 * x; });
    EXPECT_EQ(levels("ten", "ten", 50), std::pair(200, 200));
    EXPECT_EQ(levels("ten", "dim", 50), std::pair(200, 50));
    EXPECT_EQ(levels("dim", "ten", 50), std::pair(50, 200));
    EXPECT_EQ(levels("twelve", "ten", 50), std::pair((64 * 50 + 30) / 16, 800 / 16));
    EXPECT_EQ(levels("all", "all", 50), std::pair(200, 200));
    EXPECT_EQ(levels("warm", "warm", 50), std::pair(200, 200));
    EXPECT_EQ(levels("eight", "eight", 50), std::pair(200, 200));
  }
}

/// Colour of machine cameras, and gray with opacity.
TEST(Wide, ColoursAreScaledAsGrayIs) {
  const TempFolder dir;
  for (const auto& [codec, format] : {std::pair(AV_CODEC_ID_PNG, AV_PIX_FMT_RGB48BE),
                                      {AV_CODEC_ID_PNG, AV_PIX_FMT_RGBA64BE},
                                      {AV_CODEC_ID_PNG, AV_PIX_FMT_YA16BE},
                                      {AV_CODEC_ID_TIFF, AV_PIX_FMT_RGB48LE}}) {
    Encoder encoder = make_encoder(codec, format);
    const av::DecodedFrame frame = pattern(format, 0);
    const WideFormat wide = wide_format(format);
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x)
        for (int c = 0; c < wide.channels; ++c) {
          const bool opacity = c == 3 || (wide.channels == 2 && c == 1);
          const unsigned v = opacity ? 65535 : static_cast<unsigned>(16 * x + c);  // ten bits
          std::uint8_t* p = frame->data[0] + y * frame->linesize[0] + 2 * (x * wide.channels + c);
          p[wide.little_endian ? 0 : 1] = static_cast<std::uint8_t>(v);
          p[wide.little_endian ? 1 : 0] = static_cast<std::uint8_t>(v >> 8);
        }
    encoder.encode(frame.get(), [&](AVPacket& p) {
      put(dir / "wide", {reinterpret_cast<char*>(p.data), static_cast<std::size_t>(p.size)});
    });
    auto source = open_source(dir / "wide");
    ASSERT_TRUE(source) << source.error().what;
    Picture picture;
    ASSERT_TRUE((*source)->next(picture));
    EXPECT_EQ(picture.pixels.at(9, 50).r, 200) << format;
    EXPECT_EQ(picture.pixels.at(9, 50).b, 200) << format;
  }
}

/// A TIFF's second directory is a copy of its first at its end, and a third, of a smaller copy, follows.
std::string with_more_pages(std::string tiff) {
  const auto at = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<std::uint8_t>(tiff[i])); };
  const auto put_at = [&](std::size_t i, std::size_t value) {
    for (std::size_t k = 0; k < 4; ++k) tiff[i + k] = static_cast<char>(value >> 8 * k);
  };
  std::size_t first = at(4) | at(5) << 8 | at(6) << 16, link = first + 2 + 12 * at(first);
  const std::string directory = tiff.substr(first, link + 4 - first);
  for (int page = 1; page < 3; ++page) {
    put_at(link, tiff.size());
    link = tiff.size() + directory.size() - 4;
    tiff += directory;
    put_at(link, 0);
  }
  const std::size_t entry = tiff.size() - directory.size() + 2;  // the first one of the last directory becomes its kind
  tiff.replace(entry, 12, std::string("\xfe\0\x04\0\x01\0\0\0\x01\0\0\0", 12));
  return tiff;
}

TEST(SeveralPictures, OfOneFileTheFirstIsUsedAndTheOthersAreSaid) {
  const TempFolder dir;
  const auto warning_of = [&](const std::string& name, const std::string& bytes) {
    put(dir / name, bytes);
    const auto source = open_source(dir / name);
    EXPECT_TRUE(source) << name << ": " << source.error().what;
    return source ? (*source)->warning() : "";
  };
  const std::string tiff = coded(AV_CODEC_ID_TIFF, AV_PIX_FMT_GRAY8), png = coded(AV_CODEC_ID_PNG, AV_PIX_FMT_GRAY8);
  EXPECT_EQ(warning_of("one.tif", tiff), "");
  EXPECT_NE(warning_of("three.tif", with_more_pages(tiff)).find("three.tif holds 2 pictures"), std::string::npos);
  EXPECT_EQ(warning_of("one.png", png), "");
  const std::string frames = big(8, 4) + "acTL" + big(3, 4) + big(0, 4) + big(0, 4);  // with a checksum that nobody reads
  EXPECT_EQ(pictures_held(png.substr(0, 33) + frames + png.substr(33)), 3);
  const std::string pgm = "P5\n# a comment\n4 2\n255\n" + std::string(8, 'x'), ppm = "P6 2 2 65535\n" + std::string(24, 'x');
  EXPECT_EQ(warning_of("one.pgm", pgm), "");
  EXPECT_NE(warning_of("two.pgm", pgm + pgm).find("holds 2 pictures"), std::string::npos);
  EXPECT_EQ(pictures_held(ppm + ppm + pgm), 3);
  EXPECT_EQ(pictures_held(pgm + "P5 9999999999999999999999 1 255\n"), 1);
  EXPECT_EQ(pictures_held("P5"), 1);
  std::string circle = tiff;  // its directory follows itself
  const std::size_t first = static_cast<std::uint8_t>(circle[4]) | static_cast<std::uint8_t>(circle[5]) << 8 |
                            static_cast<std::uint8_t>(circle[6]) << 16;
  const std::size_t link = first + 2 + 12 * static_cast<std::uint8_t>(circle[first]);
  for (std::size_t k = 0; k < 4; ++k) circle[link + k] = circle[4 + k];
  EXPECT_EQ(pictures_held(circle), 1);
}

void replace_tag(std::string& tiff, unsigned tag, unsigned value) {
  const auto at = [&](std::size_t i) { return static_cast<unsigned>(static_cast<std::uint8_t>(tiff[i])); };
  const std::size_t directory = at(4) | at(5) << 8 | at(6) << 16;
  for (std::size_t i = 0, n = at(directory); i < n; ++i) {
    const std::size_t entry = directory + 2 + 12 * i;
    if ((at(entry) | at(entry + 1) << 8) != tag) continue;
    tiff[entry + 8] = static_cast<char>(value);
    tiff[entry + 9] = static_cast<char>(value >> 8);
  }
}

TEST(Unsupported, WholeFilesAreNotCalledDamagedAndNeverBlack) {
  const TempFolder dir;
  const std::string tiff = coded(AV_CODEC_ID_TIFF, AV_PIX_FMT_GRAY8);
  ASSERT_TRUE(tiff.starts_with("II"));
  const auto refused = [&](const std::string& name, const std::string& bytes, const char* words) {
    put(dir / name, bytes);
    const auto source = open_source(dir / name);
    ASSERT_FALSE(source) << name;
    EXPECT_NE(source.error().what.find(words), std::string::npos) << source.error().what;
    EXPECT_EQ(source.error().what.find("damaged"), std::string::npos) << source.error().what;
    EXPECT_EQ(source.error().what.find('\n'), std::string::npos);
  };
  constexpr unsigned kCompression = 259;
  for (const auto& [value, words] : {std::pair(7u, "JPEG inside"),
                                     {50000u, "Zstandard"},
                                     {34712u, "JPEG 2000"},
                                     {34925u, "LZMA"},
                                     {777u, "compression 777"}}) {
    std::string other = tiff;
    replace_tag(other, kCompression, value);
    refused("a.tif", other, words);
  }
  refused("a.heic", big(24, 4) + "ftypheic" + std::string(12, '\0'), "HEIC");
  refused("a.avif", big(24, 4) + "ftypavif" + std::string(12, '\0'), "AVIF");
  refused("a.gif", "GIF89a" + std::string(30, '\0'), "GIF");
  refused("a.jxl", "\xff\x0a" + std::string(30, 'x'), "JPEG XL");
  refused("a.webp", "RIFF" + std::string("\x20\0\0\0WEBPVP8X\x0a\0\0\0\x02\0\0\0", 20) + std::string(12, '\0'),
          "a moving WebP");
  refused("a.h264", std::string("\0\0\0\x01\x67\x64\0\x1f", 8) + std::string(30, 'x'), "bare H.264, which holds no times");
  refused("a.h265", std::string("\0\0\0\x01\x40\x01\x0c", 7) + std::string(30, 'x'), "ffmpeg -r 30 -i");
  refused("b.h265", std::string("\0\0\x01\x40\x01\x0c", 6) + std::string(30, 'x'), "bare H.265, which holds no times");
  refused("a.exr", "\x76\x2f\x31\x01" + std::string(30, 'x'), "an OpenEXR file");
  refused("a.y4m", "YUV4MPEG2 W64 H48 F30:1\n" + std::string(64, 'x'), "ffmpeg -i FILE -c copy");
  refused("a.pfm", "Pf\n4 4\n-1\n" + std::string(64, '\0'), "PFM");
  std::string arithmetic = coded(AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P);
  const std::size_t frame = arithmetic.find("\xff\xc0"sv);
  ASSERT_NE(frame, std::string::npos);
  arithmetic[frame + 1] = '\xc9';
  refused("a.jpg", arithmetic, "arithmetic coding");
}

}  // namespace
}  // namespace duo
