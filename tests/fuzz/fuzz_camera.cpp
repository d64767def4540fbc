// Any bytes as a camera's buffer, right before memory that nobody may read; the first six say which format and size it has.
#include <sys/mman.h>

#include <cstdint>
#include <cstring>

#include "core/check.h"
#include "sources/camera/decode.h"

int fuzz_camera(const std::uint8_t* data, std::size_t size) {
  using duo::CameraDecoder;
  constexpr std::size_t kHead = 6, kRoom = 1 << 20, kPage = 4096;
  static auto* const room = [] {
    auto* start = static_cast<char*>(mmap(nullptr, kRoom + kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    DUO_CHECK(start != MAP_FAILED && mprotect(start + kRoom, kPage, PROT_NONE) == 0);
    return start;
  }();
  if (size < kHead || size - kHead > kRoom) return 0;
  duo::CameraFormat format;
  format.fourcc = CameraDecoder::kFourccs[data[0] % CameraDecoder::kFourccs.size()];
  format.size = {1 + data[1] + (data[2] & 7) * 256, 1 + data[3]};
  format.stride_bytes = data[4] * (data[5] & 15);
  char* bytes = room + kRoom - (size - kHead);
  std::memcpy(bytes, data + kHead, size - kHead);
  static CameraDecoder decoder;
  duo::Picture picture;
  if (decoder.decode(format, {bytes, size - kHead}, picture) == CameraDecoder::Outcome::kWhole)
    DUO_CHECK(picture.pixels.size() == format.size);
  return 0;
}
