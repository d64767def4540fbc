#include "sources/packet_check.h"

#include <algorithm>
#include <iterator>

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

bool has_hole(const AVPacket& packet, AVCodecID codec) {
  // H.264, H.265 and MPEG write no three in a row; VP8, VP9 and AV1 only for hundred thousands of most likely symbols.
  constexpr AVCodecID kKinds[] = {AV_CODEC_ID_H264,       AV_CODEC_ID_HEVC,       AV_CODEC_ID_MPEG4, AV_CODEC_ID_H263,
                                  AV_CODEC_ID_MPEG1VIDEO, AV_CODEC_ID_MPEG2VIDEO, AV_CODEC_ID_VP8,   AV_CODEC_ID_VP9,
                                  AV_CODEC_ID_AV1};
  constexpr int kFewest = 256;
  if (std::find(std::begin(kKinds), std::end(kKinds), codec) == std::end(kKinds)) return false;
  const std::uint8_t *const data = packet.data, *const end = data + packet.size;
  // Each hole holds a byte of these places.
  for (std::ptrdiff_t at = kFewest - 1; at < packet.size; at += kFewest) {
    if (data[at] != 0) continue;
    const auto *from = data + at, *to = data + at;
    while (from > data && from[-1] == 0) --from;
    to = std::find_if(to, end, [](std::uint8_t byte) { return byte != 0; });
    if (to - from >= kFewest) return true;
  }
  return false;
}

}  // namespace duo
