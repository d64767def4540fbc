#include "stages/match_planes/match_planes_vk.h"

#include "stages/types/noise.h"
#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

/// Byte `byte` of word `word` of each pixel.
Image<std::uint8_t> unpacked(const Image<std::uint32_t>& packed, Size size, int word, int byte) {
  Image<std::uint8_t> out(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      out.at(y, x) = static_cast<std::uint8_t>(packed.at(word * size.height + y, x) >> 8 * byte);
  return out;
}

void expect_same_planes(const duo::MatchPlanes& want, const Image<std::uint32_t>& got, const std::string& what) {
  const Size size = want.size();
  const auto expect = [&](View<const std::uint8_t> plane, int word, int byte) {
    test::expect_same<std::uint8_t>(plane, unpacked(got, size, word, byte),
                                    what + " word " + std::to_string(word) + " byte " + std::to_string(byte));
  };
  for (int c = 0; c < duo::MatchPlanes::kChannels; ++c) {
    const auto i = static_cast<std::size_t>(c);
    expect(want.value[i], 0, c);
    expect(want.low[i], 1, c);
    expect(want.high[i], 2, c);
  }
  expect(want.outside, 0, 3);
  expect(want.census[0], 1, 3);
  expect(want.census[1], 2, 3);
}

TEST(MatchPlanesVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    std::mt19937 rng(7);
    const auto stage = must(vk::MatchPlanes::make(device));
    auto recorder = must(vk::Recorder::make(device));
    for (const Size size : {Size{1, 1}, Size{2, 3}, Size{16, 8}, Size{17, 9}, Size{33, 6}, Size{131, 37}})
      for (const test::Fill how : test::kFills)
        for (const bool masked : {false, true}) {
          const int noise_q4 = masked ? 70 : 0;
          const bool clear = rng() % 2 == 0;
          const std::int32_t known = clear ? 1 : -1;
          const auto word = must(vk::make_filled(device, "clear", std::as_bytes(std::span(&known, 1))));
          Image<std::uint8_t> gray(size), inside(size);
          test::fill(gray.view(), how, rng);
          for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x) inside.at(y, x) = rng() % 13 ? 255 : 0;
          PlaneImages want(size, 0);
          ref::match_planes(gray, masked ? View<const std::uint8_t>(inside) : View<const std::uint8_t>{},
                            census_dead_zone(noise_q4), clear, want);

          const OnDevice<std::uint8_t> in(device, gray, "gray"), mask(device, inside, "inside");
          const auto noise = must(vk::Buffer::make(device, "noise", sizeof(std::uint32_t), vk::Memory::kDevice));
          const OnDevice<std::uint32_t> out(device, vk::MatchPlanes::packed_size(size), "planes");
          test::run_with(
              recorder,
              [&] {
                recorder.fill(noise, noise_q4);
                stage.record(recorder, in.view(), masked ? mask.view() : vk::BufferView<std::uint8_t>{}, noise, word,
                             out.view(), size);
              },
              in, mask, out);
          const std::string what = "match_planes" + where;
          expect_same_planes(want.planes(), out.pixels(what), what);
          if (::testing::Test::HasFailure()) return;
        }
  });
}

}  // namespace
}  // namespace duo
