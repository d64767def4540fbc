#include "sources/libav.h"

extern "C" {
#include <libavutil/pixdesc.h>
}

namespace duo::av {
namespace {

// libswscale's own gray and 16-bit paths round through YUV; a gray value must stay what it is (ground truth comes as gray).
template <class T, int kShift>
void gray_to_rgb(const AVFrame& frame, Image<Rgb8>& into) {
  for (int y = 0; y < into.height(); ++y) {
    const T* src = reinterpret_cast<const T*>(frame.data[0] + std::ptrdiff_t{y} * frame.linesize[0]);
    for (int x = 0; x < into.width(); ++x) {
      const auto v = static_cast<std::uint8_t>(src[x] >> kShift);
      into.at(y, x) = {v, v, v};
    }
  }
}

// The deprecated "J" formats are the plain ones with full range; libswscale warns about them otherwise.
AVPixelFormat without_j(AVPixelFormat format, bool& full_range) {
  switch (format) {
    case AV_PIX_FMT_YUVJ420P:
      full_range = true;
      return AV_PIX_FMT_YUV420P;
    case AV_PIX_FMT_YUVJ422P:
      full_range = true;
      return AV_PIX_FMT_YUV422P;
    case AV_PIX_FMT_YUVJ444P:
      full_range = true;
      return AV_PIX_FMT_YUV444P;
    case AV_PIX_FMT_YUVJ440P:
      full_range = true;
      return AV_PIX_FMT_YUV440P;
    case AV_PIX_FMT_YUVJ411P:
      full_range = true;
      return AV_PIX_FMT_YUV411P;
    default:
      return format;
  }
}

}  // namespace

bool ToRgb::convert(const AVFrame& frame, Image<Rgb8>& into) {
  const Size size{frame.width, frame.height};
  if (size.empty() || size.width > kMaxSide || size.height > kMaxSide) return false;
  if (into.size() != size) into = Image<Rgb8>(size);
  if (frame.format == AV_PIX_FMT_GRAY8) return gray_to_rgb<std::uint8_t, 0>(frame, into), true;
  if (frame.format == AV_PIX_FMT_GRAY16LE) return gray_to_rgb<std::uint16_t, 8>(frame, into), true;
  // A big-endian 16-bit value read as little-endian has its high byte below.
  if (frame.format == AV_PIX_FMT_GRAY16BE) return gray_to_rgb<std::uint16_t, 0>(frame, into), true;

  if (!scaler_ || size != size_ || frame.format != format_ || frame.colorspace != colorspace_ || frame.color_range != range_) {
    bool full_range = frame.color_range == AVCOL_RANGE_JPEG;
    const AVPixelFormat format = without_j(static_cast<AVPixelFormat>(frame.format), full_range);
    constexpr int kFlags = SWS_BILINEAR | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_FULL_CHR_H_INP | SWS_BITEXACT;
    scaler_.reset(sws_getContext(size.width, size.height, format, size.width, size.height, AV_PIX_FMT_RGB24, kFlags, nullptr,
                                 nullptr, nullptr));
    if (!scaler_) return false;
    constexpr int kOne = 1 << 16;
    sws_setColorspaceDetails(scaler_.get(), sws_getCoefficients(frame.colorspace), full_range ? 1 : 0,
                             sws_getCoefficients(SWS_CS_DEFAULT), 1, 0, kOne, kOne);
    size_ = size;
    format_ = frame.format;
    colorspace_ = frame.colorspace;
    range_ = frame.color_range;
  }
  std::uint8_t* planes[4] = {reinterpret_cast<std::uint8_t*>(into.row(0))};
  const int strides[4] = {static_cast<int>(into.stride() * 3)};
  return sws_scale(scaler_.get(), frame.data, frame.linesize, 0, size.height, planes, strides) == size.height;
}

}  // namespace duo::av
