// Reading with libav: decoders, and their frames as our pictures.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "core/capture_mark.h"
#include "core/libav.h"
#include "duoptic/frame.h"
#include "duoptic/result.h"
#include "sources/wide_values.h"
#include "stages/yuv_rgb/yuv_rgb.h"

namespace duo::av {

struct CloseInput {
  void operator()(AVFormatContext* p) const { avformat_close_input(&p); }
};
using Container = std::unique_ptr<AVFormatContext, CloseInput>;
using Decoder = Coder;
using DecodedFrame = CodedFrame;

/// What duo::limit_pictures() was told last.
std::int64_t most_pixels();
/// libav counts what it decodes into, with its edges: nothing that we read is refused by this limit.
std::int64_t most_pixels_of_libav();
/// "" or why pictures of this size are not read.
std::string too_many_pixels(Size size);
std::string too_many_pixels();

/// What a container may be, and by which protocols it may open anything: comma-separated. False without memory.
bool allow_only(AVFormatContext& container, const char* formats, const char* protocols);

/// avformat_find_stream_info(), which may decode: but no picture with too many pixels.
int find_streams(AVFormatContext& container);

/// "cannot read NAME: why", with a code that tells what is wrong with the input from what is wrong with the machine.
Error input_error(const std::string& name, int error, const std::string& why);

/// Opens a decoder that runs on the caller's thread alone; `configure` sees it before it is opened.
///
/// Errors  nullptr when this build of libav does not know the codec or refuses the parameters
template <class Configure>
Decoder open_decoder(AVCodecID id, Configure&& configure) {
  const AVCodec* codec = avcodec_find_decoder(id);
  Decoder decoder(codec ? avcodec_alloc_context3(codec) : nullptr);
  if (!decoder) return nullptr;
  decoder->thread_count = 1;
  decoder->max_pixels = most_pixels_of_libav();
  decoder->flags |= AV_CODEC_FLAG_BITEXACT;
  if (!configure(*decoder) || avcodec_open2(decoder.get(), codec, nullptr) < 0) return nullptr;
  return decoder;
}

/// True when the decoder itself says that parts of the picture are missing or guessed.
inline bool is_damaged(const AVFrame& frame) {
  return (frame.flags & AV_FRAME_FLAG_CORRUPT) != 0 || frame.decode_error_flags != 0;
}

/// A time in `base` as nanoseconds; 0 when it is not known. What a damaged file says is cut to 31 years, so that sums of a few
/// fit.
inline TimeNs to_ns(std::int64_t t, AVRational base) {
  if (t == AV_NOPTS_VALUE) return 0;
  return std::clamp(av_rescale_q(t, base, AVRational{1, 1'000'000'000}), -CaptureMark::kMost_ns, CaptureMark::kMost_ns);
}

/// When a packet's picture was taken: by its mark, else by its time in the file, whose unit is `base`.
inline TimeNs capture_ns(const AVPacket& packet, AVRational base) {
  const auto mark = CaptureMark::of(packet);
  return mark ? mark->t_ns : to_ns(packet.pts, base);
}

/// Turns decoded frames of any pixel format into Rgb8: 16-bit and gray converted, alpha dropped; the same bits on every
/// machine.
class ToRgb {
 public:
  /// Sees a frame before it is converted: of 16 bits, how many are used.
  void see(const AVFrame& frame) { wide_->see(frame); }
  /// Both convert 16 bits alike from now on.
  void scale_as(ToRgb& other) {
    wide_->see(*other.wide_);
    other.wide_ = wide_;
  }
  /// False when the pixel format cannot be converted or the picture is larger than kMaxSide. libswscale reads in steps of its
  /// own: kReadBeyond bytes after the last row's must be there.
  bool convert(const AVFrame& frame, Image<Rgb8>& into);
  static constexpr std::size_t kReadBeyond = 64;
  static constexpr int kMaxSide = 16384;

 private:
  std::shared_ptr<WideScale> wide_ = std::make_shared<WideScale>();
  std::optional<simd::YuvScratch> yuv_;  // of JPEGs
  Scaler scaler_;
  int format_ = -1, colorspace_ = -1, range_ = -1;
  Size size_;
};

}  // namespace duo::av
