// A network of integer layers: what its file says, checked.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "stages/add16/add16.h"
#include "stages/conv_first16/conv_first16.h"
#include "stages/depthwise16/depthwise16.h"
#include "stages/matmul16/matmul16.h"

namespace duo {

/// A layer without constants of its own.
struct Resize2x16 {};
struct Maxpool2x16 {};
struct DepthToSpace16 {};
struct SumPixels16 {
  int shift = 0;
};

/// What a layer does. The order is the file's numbering.
using LayerWork = std::variant<ConvFirst16, Matmul16, Depthwise16, Add16, Resize2x16, Maxpool2x16, SumPixels16, DepthToSpace16>;

/// Reads tensor `a`, an addition also `b`, and writes `y`, which no other layer writes. a, b < y.
struct NetLayer {
  LayerWork work;
  int a = 0, b = -1, y = 0;
};

/// Units  a value v means v / 2^exponent
struct NetTensor {
  Size size;
  int channels = 0;
  int exponent = 0;
  Range16 range;
  std::size_t count() const { return static_cast<std::size_t>(size.width) * size.height * channels; }
};

struct NetOutput {
  std::string name;
  int tensor = 0;
};

/// Tensor 0 is the input, tensor i + 1 the result of layer i.
struct Net {
  std::string name;
  std::vector<NetTensor> tensors;
  std::vector<NetLayer> layers;
  std::vector<NetOutput> outputs;
  std::unique_ptr<std::uint64_t[]> constants;  // the memory that the layers' spans lie in
  std::uint64_t hash = 0;                      // of the file

  /// The tensor that an output of that name is; none when there is none.
  std::optional<int> output(std::string_view output_name) const {
    for (const NetOutput& each : outputs)
      if (each.name == output_name) return each.tensor;
    return std::nullopt;
  }
};

}  // namespace duo
