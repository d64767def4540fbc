// Any bytes as a PFM picture: no crash, and no pixel that the bytes do not hold.
#include <cstdint>
#include <string_view>

#include "core/check.h"
#include "duoptic/sink.h"

int fuzz_pfm(const std::uint8_t* data, std::size_t size) {
  const auto picture = duo::parse_pfm({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!picture) return 0;
  DUO_CHECK(!picture->empty() && std::size_t{4} * picture->width() * picture->height() < size);
  return 0;
}
