// Pairs as two webcams give them, a recording of them, and what comes back out of it.
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "duoptic/recording.h"
#include "duoptic/source.h"
#include "duoptic/synthetic.h"
#include "tests/write_media.h"

namespace duo::test {

/// Noise and slopes in RGB: nothing that 4:2:0 could keep.
inline Image<Rgb8> pixels_of(int t, int side) {
  std::mt19937 random(static_cast<unsigned>(2 * t + side));
  Image<Rgb8> out(kSize);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      out.at(y, x) = {static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(4 * x + t),
                      static_cast<std::uint8_t>(5 * y)};
  return out;
}

inline std::vector<std::uint8_t> jpeg_of(int t) {
  Encoder encoder = make_encoder(AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P);
  std::vector<std::uint8_t> bytes;
  encoder.encode(pattern(AV_PIX_FMT_YUVJ420P, t).get(), [&](AVPacket& p) { bytes.assign(p.data, p.data + p.size); });
  return bytes;
}

/// Pair number t of two free-running cameras: odd nanoseconds, a right picture that is earlier or later, numbers that skip.
inline Pair pair_of(int t, bool jpeg) {
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
inline constexpr TimeNs kStart_ns = 987'654'321'123 - 4'000'001;  // the first right picture

inline RecorderSetup setup_with_rig() { return {.frame_s = 0.033333337, .rig = synthetic_rig({.size = kSize})}; }

struct Written {
  std::string bytes;
  std::vector<std::size_t> end_of_pair;  // bytes of the file when each pair was in it
};

inline Written write_recording(const std::filesystem::path& path, int pairs, bool jpeg) {
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
  Next end = Next::kNew;
  std::string warning, error;
};

inline Played play(const std::filesystem::path& path) {
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
    if (!next || *next != Next::kNew) return out;
    out.pairs.push_back(std::move(pair));
  }
}

inline bool same(const Image<Rgb8>& a, const Image<Rgb8>& b) {
  if (a.size() != b.size()) return false;
  for (int y = 0; y < a.height(); ++y)
    if (!std::equal(a.row(y), a.row(y) + a.width(), b.row(y))) return false;
  return true;
}

}  // namespace duo::test
