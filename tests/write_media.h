// Pictures and videos written with libav's encoders, and a folder for them that goes away with the test.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "duoptic/image.h"
#include "sources/libav.h"

extern "C" {
#include <libavutil/imgutils.h>
#include <libavutil/opt.h>
}

namespace duo::test {

inline constexpr int kFrames = 12;
inline constexpr Size kSize{64, 48};

class TempFolder {
 public:
  TempFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "duoptic_files_XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TempFolder() { std::filesystem::remove_all(path_); }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}
inline void put(const std::filesystem::path& path, std::string_view bytes) { std::ofstream(path, std::ios::binary) << bytes; }

/// A moving pattern with something in every byte of every plane.
inline av::DecodedFrame pattern(AVPixelFormat format, int t) {
  av::DecodedFrame frame(av_frame_alloc());
  frame->format = format;
  frame->width = kSize.width;
  frame->height = kSize.height;
  frame->pts = t;
  EXPECT_GE(av_frame_get_buffer(frame.get(), 0), 0);
  for (int plane = 0; plane < 4 && frame->data[plane] != nullptr; ++plane) {
    const bool halved = plane > 0 && (format == AV_PIX_FMT_YUVJ420P || format == AV_PIX_FMT_YUV420P);
    const int height = halved ? kSize.height / 2 : kSize.height;
    const int width = av_image_get_linesize(format, kSize.width, plane);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        frame->data[plane][y * frame->linesize[plane] + x] = static_cast<std::uint8_t>(x * 5 + y * 3 + t * 7 + ((x * y) & 31));
  }
  return frame;
}

struct Encoder {
  av::Coder context;
  void encode(const AVFrame* frame, const std::function<void(AVPacket&)>& write) {
    ASSERT_GE(avcodec_send_frame(context.get(), frame), 0);
    const av::Packet packet(av_packet_alloc());
    while (avcodec_receive_packet(context.get(), packet.get()) >= 0) {
      write(*packet);
      av_packet_unref(packet.get());
    }
  }
};

inline Encoder make_encoder(AVCodecID id, AVPixelFormat format, int b_frames = 0, bool global_header = false,
                            int key_every = 12) {
  const AVCodec* codec = avcodec_find_encoder(id);
  Encoder encoder{av::Coder(avcodec_alloc_context3(codec))};
  AVCodecContext& c = *encoder.context;
  c.width = kSize.width;
  c.height = kSize.height;
  c.pix_fmt = format;
  c.color_range = format == AV_PIX_FMT_YUVJ420P ? AVCOL_RANGE_JPEG : AVCOL_RANGE_UNSPECIFIED;
  c.time_base = {1, 30};
  c.framerate = {30, 1};
  c.max_b_frames = b_frames;
  c.gop_size = key_every;
  if (id == AV_CODEC_ID_FFV1) c.level = 3;  // with checksums
  c.bit_rate = 400'000;
  c.strict_std_compliance = FF_COMPLIANCE_UNOFFICIAL;
  if (global_header) c.flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  EXPECT_GE(avcodec_open2(&c, codec, nullptr), 0);
  return encoder;
}

inline void write_picture(const std::filesystem::path& path, AVCodecID id, AVPixelFormat format) {
  Encoder encoder = make_encoder(id, format);
  const av::DecodedFrame frame = pattern(format, 0);
  encoder.encode(frame.get(), [&](AVPacket& p) {
    put(path, {reinterpret_cast<char*>(p.data), static_cast<std::size_t>(p.size)});
  });
}

/// How a video is written, where that matters.
struct VideoStyle {
  int b_frames = 0;
  int key_every = 12;
  AVRational unit = {1, 30};                                    // of times
  std::vector<std::pair<const char*, const char*>> muxer = {};  // options
  std::function<void(AVStream&)> stream = [](AVStream&) {};     // what else is said of it
};

/// A video whose pictures, pattern(times[i]), come at these times.
inline void write_video_at(const std::filesystem::path& path, AVCodecID id, AVPixelFormat format, const std::vector<int>& times,
                           const VideoStyle& style = {}) {
  AVFormatContext* muxer = nullptr;
  ASSERT_GE(avformat_alloc_output_context2(&muxer, nullptr, nullptr, path.c_str()), 0);
  Encoder encoder =
      make_encoder(id, format, style.b_frames, (muxer->oformat->flags & AVFMT_GLOBALHEADER) != 0, style.key_every);
  AVStream* stream = avformat_new_stream(muxer, nullptr);
  stream->time_base = style.unit;
  stream->avg_frame_rate = av_inv_q(style.unit);
  avcodec_parameters_from_context(stream->codecpar, encoder.context.get());
  style.stream(*stream);
  for (const auto& [name, value] : style.muxer) ASSERT_GE(av_opt_set(muxer->priv_data, name, value, 0), 0);
  ASSERT_GE(avio_open(&muxer->pb, path.c_str(), AVIO_FLAG_WRITE), 0);
  ASSERT_GE(avformat_write_header(muxer, nullptr), 0);
  const auto write = [&](AVPacket& packet) {
    if (packet.duration == 0) packet.duration = 1;
    av_packet_rescale_ts(&packet, style.unit, stream->time_base);
    ASSERT_GE(av_interleaved_write_frame(muxer, &packet), 0);
  };
  for (const int t : times) encoder.encode(pattern(format, t).get(), write);
  encoder.encode(nullptr, write);
  ASSERT_GE(av_write_trailer(muxer), 0);
  avio_closep(&muxer->pb);
  avformat_free_context(muxer);
}

inline void write_video(const std::filesystem::path& path, AVCodecID id, AVPixelFormat format, int b_frames,
                        const char* movflags = nullptr) {
  std::vector<int> times(kFrames);
  std::iota(times.begin(), times.end(), 0);
  VideoStyle style{.b_frames = b_frames};
  if (movflags != nullptr) style.muxer = {{"movflags", movflags}};
  write_video_at(path, id, format, times, style);
}

}  // namespace duo::test
