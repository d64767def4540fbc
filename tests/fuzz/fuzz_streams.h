// Any bytes as what comes from another machine or process.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "core/check.h"
#include "sources/stream_input.h"

namespace duo::fuzz {

/// Bytes that come some at a time.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}
  int operator()(std::uint8_t* into, int most) {
    constexpr std::size_t kPart = 1000;
    const std::size_t n = std::min({left_, static_cast<std::size_t>(most), kPart});
    std::copy_n(data_, n, into);
    data_ += n;
    left_ -= n;
    return static_cast<int>(n);
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

inline void read_all(StreamInput& input) {
  constexpr int kMost = 20;
  Picture picture;
  for (int i = 0; i < kMost && input.next(picture); ++i) DUO_CHECK(!picture.pixels.empty());
}

inline void set_up() {
  av_log_set_level(AV_LOG_QUIET);
  limit_pictures(1 << 20);
}

}  // namespace duo::fuzz
