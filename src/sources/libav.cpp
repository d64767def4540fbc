#include "sources/libav.h"

extern "C" {
#include <libavutil/pixdesc.h>
}

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <vector>

#include "core/file.h"
#include "duoptic/source.h"

namespace duo::av {
namespace {

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

/// The planes of a JPEG of full range and half as much chroma; nothing of another kind of picture.
std::optional<YuvPlanes> jpeg_planes(const AVFrame& frame) {
  bool full_range = frame.color_range == AVCOL_RANGE_JPEG;
  const AVPixelFormat format = without_j(static_cast<AVPixelFormat>(frame.format), full_range);
  const bool half_rows = format == AV_PIX_FMT_YUV420P;
  const int w = frame.width, h = frame.height;
  if (!full_range || (!half_rows && format != AV_PIX_FMT_YUV422P)) return std::nullopt;
  if (w % 2 != 0 || h % 2 != 0 || std::min(w, h) < YuvPlanes::kLeast) return std::nullopt;
  const auto plane = [&](int i, Size size) { return View<const std::uint8_t>(frame.data[i], size, frame.linesize[i]); };
  const Size chroma{w / 2, half_rows ? h / 2 : h};
  return YuvPlanes{plane(0, {w, h}), plane(1, chroma), plane(2, chroma)};
}

/// As libswscale makes them of its coefficients for full range.
YuvWeights yuv_weights(int colorspace) {
  const int* const c = sws_getCoefficients(colorspace);  // red of v, blue of u, green of u and v, the latter to be subtracted
  const auto weight = [](std::int64_t value) {
    return static_cast<std::int16_t>((value * 224 / 255 * (1 << 13) + (1 << 15)) >> 16);
  };
  return {weight(c[0]), weight(-c[2]), weight(-c[3]), weight(c[1])};
}

std::atomic<std::int64_t> pixel_limit = kMostPixels;

}  // namespace

std::int64_t most_pixels() { return pixel_limit; }

std::int64_t most_pixels_of_libav() { return 2 * most_pixels() + (1 << 16); }

std::string too_many_pixels() {
  return fmt::format("more than the {:.3g} million pixels that are read; --max-megapixels reads more",
                     static_cast<double>(most_pixels()) * 1e-6);
}

std::string too_many_pixels(Size size) {
  if (std::int64_t{size.width} * size.height <= most_pixels()) return {};
  return fmt::format("its pictures have {}x{} pixels, {}", size.width, size.height, too_many_pixels());
}

bool allow_only(AVFormatContext& container, const char* formats, const char* protocols) {
  container.format_whitelist = av_strdup(formats);
  container.protocol_whitelist = av_strdup(protocols);
  return container.format_whitelist != nullptr && container.protocol_whitelist != nullptr;
}

int find_streams(AVFormatContext& container) {
  const unsigned known = container.nb_streams;  // those that turn up later have small pictures, or are not opened
  std::vector<AVDictionary*> options(known);
  for (AVDictionary*& one : options) av_dict_set_int(&one, "max_pixels", most_pixels_of_libav(), 0);
  const int found = avformat_find_stream_info(&container, options.data());
  for (AVDictionary*& one : options) av_dict_free(&one);
  return found;
}

Error input_error(const std::string& name, int error, const std::string& why) {
  if (is_exhausted(AVUNERROR(error)))
    return {ErrorCode::kExhausted, fmt::format("cannot read {}: {}; close other programs", name,
                                               error == AVERROR(ENOMEM) ? "out of memory" : reason(error))};
  return {ErrorCode::kBadInput, fmt::format("cannot read {}: {}", name, why)};
}

bool ToRgb::convert(const AVFrame& frame, Image<Rgb8>& into) {
  const Size size{frame.width, frame.height};
  if (size.empty() || size.width > kMaxSide || size.height > kMaxSide || !too_many_pixels(size).empty()) return false;
  if (into.size() != size) into = Image<Rgb8>(size);
  // libswscale's own gray and 16-bit paths round through YUV; a gray value must stay what it is (ground truth comes as gray).
  if (frame.format == AV_PIX_FMT_GRAY8) {
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const std::uint8_t v = frame.data[0][std::ptrdiff_t{y} * frame.linesize[0] + x];
        into.at(y, x) = {v, v, v};
      }
    return true;
  }
  if (const WideFormat wide = wide_format(frame.format); wide.channels > 0) {
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const auto value = [&](int c) { return wide_->of(wide_value(frame, wide, y, x, wide.coloured() ? c : 0)); };
        into.at(y, x) = {value(0), value(1), value(2)};
      }
    return true;
  }

  if (const auto planes = jpeg_planes(frame)) {
    if (!yuv_ || yuv_->width != size.width) yuv_.emplace(size.width);
    simd::yuv_rgb(*planes, yuv_weights(frame.colorspace), *yuv_, into);
    return true;
  }

  if (!scaler_ || size != size_ || frame.format != format_ || frame.colorspace != colorspace_ || frame.color_range != range_) {
    bool full_range = frame.color_range == AVCOL_RANGE_JPEG;
    const AVPixelFormat format = without_j(static_cast<AVPixelFormat>(frame.format), full_range);
    constexpr int kFlags = SWS_BILINEAR | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_FULL_CHR_H_INP | SWS_BITEXACT;
    if (sws_isSupportedInput(format) == 0) return false;
    scaler_.reset(sws_getContext(size.width, size.height, format, size.width, size.height, AV_PIX_FMT_RGB24, kFlags, nullptr,
                                 nullptr, nullptr));
    had_memory(scaler_.get());
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

namespace duo {

void limit_pictures(std::int64_t most_pixels) { av::pixel_limit = most_pixels; }

}  // namespace duo
