// Owners of libav objects, and its error numbers as text.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

#include <cstdint>
#include <memory>
#include <string>

#include "duoptic/frame.h"
#include "duoptic/result.h"

namespace duo::av {

struct Free {
  void operator()(AVFormatContext* p) const { avformat_close_input(&p); }
  void operator()(AVCodecContext* p) const { avcodec_free_context(&p); }
  void operator()(AVFrame* p) const { av_frame_free(&p); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
  void operator()(SwsContext* p) const { sws_freeContext(p); }
};
using Container = std::unique_ptr<AVFormatContext, Free>;
using Decoder = std::unique_ptr<AVCodecContext, Free>;
using DecodedFrame = std::unique_ptr<AVFrame, Free>;
using Packet = std::unique_ptr<AVPacket, Free>;

inline std::string reason(int error) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(error, text, sizeof text);
  return text;
}

/// Opens a decoder that runs on the caller's thread alone; `configure` sees it before it is opened.
///
/// Errors  nullptr when this build of libav does not know the codec or refuses the parameters
template <class Configure>
Decoder open_decoder(AVCodecID id, Configure&& configure) {
  const AVCodec* codec = avcodec_find_decoder(id);
  Decoder decoder(codec ? avcodec_alloc_context3(codec) : nullptr);
  if (!decoder) return nullptr;
  decoder->thread_count = 1;
  decoder->flags |= AV_CODEC_FLAG_BITEXACT;
  if (!configure(*decoder) || avcodec_open2(decoder.get(), codec, nullptr) < 0) return nullptr;
  return decoder;
}

/// True when the decoder itself says that parts of the picture are missing or guessed.
inline bool is_damaged(const AVFrame& frame) {
  return (frame.flags & AV_FRAME_FLAG_CORRUPT) != 0 || frame.decode_error_flags != 0;
}

/// Turns decoded frames of any pixel format into Rgb8: 16-bit and gray converted, alpha dropped; the same bits on every
/// machine.
class ToRgb {
 public:
  /// False when the pixel format cannot be converted or the picture is larger than kMaxSide.
  bool convert(const AVFrame& frame, Image<Rgb8>& into);
  static constexpr int kMaxSide = 16384;

 private:
  std::unique_ptr<SwsContext, Free> scaler_;
  int format_ = -1, colorspace_ = -1, range_ = -1;
  Size size_;
};

}  // namespace duo::av
