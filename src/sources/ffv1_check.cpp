#include "sources/ffv1_check.h"

extern "C" {
#include <libavutil/crc.h>
#include <libavutil/intreadwrite.h>
}

namespace duo {

bool ffv1_checks(const AVPacket& packet) {
  // A slice ends with its size before these bytes (3), its state (1) and a checksum (4) over all of it, which makes it zero.
  constexpr std::size_t kFooter = 8;
  auto left = static_cast<std::size_t>(packet.size);
  while (left > kFooter) {
    const std::size_t slice = AV_RB24(packet.data + left - kFooter) + kFooter;
    if (slice > left) return false;
    left -= slice;
    if (av_crc(av_crc_get_table(AV_CRC_32_IEEE), 0, packet.data + left, slice) != 0) return false;
  }
  return left == 0 && packet.size > 0;
}

}  // namespace duo
