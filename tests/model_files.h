// The project's networks, and an input for each that is the same everywhere.
#pragma once

#include "nets/net_file.h"
#include "tests/data.h"

namespace duo::test {

inline std::filesystem::path model_path(const std::string& name) { return "models/" + name + ".net"; }

/// Slanted waves in bytes, as the model's input has them: scale and offset follow from its range. `number` chooses the picture.
inline void fill_input(Tensor16 x, Range16 range, int number = 0) {
  const int span = (range.high - range.low) / 255;
  for (int row = 0; row < x.height(); ++row)
    for (int column = 0; column < x.width(); ++column)
      for (int c = 0; c < 3; ++c) {
        const int byte = (column * (5 + number) + row * 3 + c * 70 + column * row / 64) % 256;
        x.pixel(row, column)[c] = static_cast<std::int16_t>(range.low + byte * span);
      }
}

inline std::uint64_t hash_of(ConstTensor16 x) {
  return hash_words({reinterpret_cast<const char*>(x.data()), x.count() * sizeof(std::int16_t)});
}

}  // namespace duo::test
