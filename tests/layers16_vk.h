// Random layers of tests/layers16.h on devices, with several pictures at once.
#pragma once

#include <string>
#include <vector>

#include "tests/agree_vk.h"
#include "tests/layers16.h"
#include "vulkan/tensor.h"

namespace duo::test {

inline constexpr int kPictures = 3;
inline constexpr std::size_t kConstantsAt = 7;  // word at which a layer begins

/// A buffer that has these words from kConstantsAt on.
inline vk::Buffer constants_of(vk::Device& device, const std::vector<std::int32_t>& words) {
  std::vector<std::int32_t> all(kConstantsAt, -1);
  all.insert(all.end(), words.begin(), words.end());
  return must(vk::make_filled(device, "constants", std::as_bytes(std::span(all))));
}

/// Random tensors of several pictures on a device: a row each, with a margin and an odd stride.
struct OfPictures {
  Size size;
  int channels;
  Image<std::int16_t> values;
  OnDevice<std::int16_t> memory;
  OfPictures(const vk::Device& device, Size of, int of_channels, std::mt19937& rng)
      : size(of),
        channels(of_channels),
        values(random(of.width * of.height * of_channels, rng)),
        memory(device, values, "tensors") {}

  vk::Tensors16 tensors() const { return {memory.view(), size, channels, kPictures}; }
  ConstTensor16 tensor(int picture) const { return of(values, picture); }
  ConstTensor16 of(const Image<std::int16_t>& from, int picture) const { return {from.row(picture), size, channels}; }

 private:
  static Image<std::int16_t> random(int count, std::mt19937& rng) {
    Image<std::int16_t> out({count, kPictures});
    for (int p = 0; p < kPictures; ++p) {
      const auto row = values16(static_cast<std::size_t>(count), rng);
      std::copy(row.begin(), row.end(), out.row(p));
    }
    return out;
  }
};

/// Holds a kernel with one input and one result against its plain loops. ref(x, y); record(x, y)
template <class Ref, class Record>
void agree16_vk(const std::string& what, const vk::Device& device, vk::Recorder& recorder, Size x_size, int x_channels,
                Size y_size, int y_channels, std::mt19937& rng, Ref ref, Record record) {
  const OfPictures x(device, x_size, x_channels, rng), y(device, y_size, y_channels, rng);
  run_with(
      recorder, [&] { record(x.tensors(), y.tensors()); }, x.memory, y.memory);
  const auto got = y.memory.pixels(what);
  for (int p = 0; p < kPictures; ++p) {
    Made16 want(y_size, y_channels);
    ref(x.tensor(p), want.view);
    expect_same16(want.view, y.of(got, p), what + " picture " + std::to_string(p));
  }
}

}  // namespace duo::test
