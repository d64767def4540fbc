// Capture time and number of each picture in a recording: Matroska's own times are whole milliseconds.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <optional>

#include "core/libav.h"

extern "C" {
#include <libavutil/intreadwrite.h>
}

namespace duo {

/// Capture time and number of a picture, as the packet's BlockAdditional: two big-endian 64-bit numbers. It lies in the same
/// element as the picture, so that a cut keeps both or none.
struct CaptureMark {
  static constexpr const char* kFrameTag = "DUOPTIC_FRAME_NS";  // of the file: time between pictures; marks a recording of ours
  static constexpr std::int64_t kMost_ns = 1'000'000'000'000'000'000;  // 31 years: what differs by more is damaged

  std::int64_t t_ns = 0;  // since the first capture of the recording
  std::uint64_t sequence = 0;

  /// False without memory.
  bool put(AVPacket& packet) const {
    std::uint8_t* data = av_packet_new_side_data(&packet, AV_PKT_DATA_MATROSKA_BLOCKADDITIONAL, 24);
    if (data == nullptr) return false;
    AV_WB64(data, 1);  // BlockAddID 1: means what the writer wants it to
    AV_WB64(data + 8, static_cast<std::uint64_t>(t_ns));
    AV_WB64(data + 16, sequence);
    return true;
  }
  static std::optional<CaptureMark> of(const AVPacket& packet) {
    std::size_t bytes = 0;
    const std::uint8_t* data = av_packet_get_side_data(&packet, AV_PKT_DATA_MATROSKA_BLOCKADDITIONAL, &bytes);
    if (data == nullptr || bytes != 24 || AV_RB64(data) != 1) return std::nullopt;
    const auto t_ns = static_cast<std::int64_t>(AV_RB64(data + 8));
    if (t_ns < -kMost_ns || t_ns > kMost_ns) return std::nullopt;
    return CaptureMark{t_ns, AV_RB64(data + 16)};
  }
  /// Time between the pictures of a recording of ours; 0 of other files.
  static std::int64_t frame_ns(const AVFormatContext& file) {
    const AVDictionaryEntry* tag = av_dict_get(file.metadata, kFrameTag, nullptr, 0);
    const long long ns = tag != nullptr ? std::atoll(tag->value) : 0;
    return ns > 0 && ns < kMost_ns ? ns : 0;
  }
};

}  // namespace duo
