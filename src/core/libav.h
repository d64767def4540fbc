// Owners of libav objects, and its error numbers as text.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

#include <cerrno>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <utility>

namespace duo::av {

struct Free {
  void operator()(AVCodecContext* p) const { avcodec_free_context(&p); }
  void operator()(AVFrame* p) const { av_frame_free(&p); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
  void operator()(SwsContext* p) const { sws_freeContext(p); }
};
void close_file(AVIOContext* file);  // of core/libav_file.h; what libav still holds is not written any more
struct CloseOutput {
  void operator()(AVFormatContext* p) const {
    close_file(std::exchange(p->pb, nullptr));
    avformat_free_context(p);
  }
};
using Muxer = std::unique_ptr<AVFormatContext, CloseOutput>;
using Coder = std::unique_ptr<AVCodecContext, Free>;  // a decoder or an encoder
using CodedFrame = std::unique_ptr<AVFrame, Free>;    // what comes out of one or goes into the other
using Packet = std::unique_ptr<AVPacket, Free>;
using Scaler = std::unique_ptr<SwsContext, Free>;

/// What libav returned, where it did not lack memory: std::bad_alloc is thrown then, as our own code does.
inline int had_memory(int result) {
  if (result == AVERROR(ENOMEM)) throw std::bad_alloc();
  return result;
}
template <class T>
T* had_memory(T* made) {
  if (made == nullptr) throw std::bad_alloc();
  return made;
}

inline std::string_view bytes_of(const AVPacket& packet) {
  return {reinterpret_cast<const char*>(packet.data), static_cast<std::size_t>(packet.size)};
}

inline std::string reason(int error) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(error, text, sizeof text);
  return text;
}

}  // namespace duo::av
