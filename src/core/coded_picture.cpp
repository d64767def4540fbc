#include "core/coded_picture.h"

#include <turbojpeg.h>

extern "C" {
#include <libavutil/opt.h>
}

#include <algorithm>
#include <cstring>
#include <memory>

#include "core/libav.h"

namespace duo {
namespace {

/// PNG of the rows that `copy_row(y, to)` gives.
template <class CopyRow>
std::string png(Size size, AVPixelFormat format, CopyRow&& copy_row) {
  const AVCodec* codec = avcodec_find_encoder(AV_CODEC_ID_PNG);
  if (codec == nullptr || size.empty()) return {};
  const av::Coder encoder(av::had_memory(avcodec_alloc_context3(codec)));
  const av::CodedFrame frame(av::had_memory(av_frame_alloc()));
  const av::Packet packet(av::had_memory(av_packet_alloc()));
  frame->width = encoder->width = size.width;
  frame->height = encoder->height = size.height;
  frame->format = encoder->pix_fmt = format;
  encoder->time_base = encoder->sample_aspect_ratio = {1, 1};
  encoder->thread_count = 1;
  encoder->flags |= AV_CODEC_FLAG_BITEXACT;
  encoder->compression_level = 1;  // of disparities a third larger than the best, in a third of the time
  av_opt_set(encoder->priv_data, "pred", "up", 0);
  // zlib says no more than that it failed, and memory is all that it may lack.
  const auto had_memory = [](int result) { return av::had_memory(result == AVERROR_EXTERNAL ? AVERROR(ENOMEM) : result); };
  if (had_memory(avcodec_open2(encoder.get(), codec, nullptr)) < 0 || had_memory(av_frame_get_buffer(frame.get(), 0)) < 0)
    return {};
  for (int y = 0; y < size.height; ++y) copy_row(y, frame->data[0] + std::ptrdiff_t{y} * frame->linesize[0]);
  if (had_memory(avcodec_send_frame(encoder.get(), frame.get())) < 0 ||
      had_memory(avcodec_receive_packet(encoder.get(), packet.get())) < 0)
    return {};
  return std::string(av::bytes_of(*packet));
}

}  // namespace

std::string png_of(View<const Rgb8> picture) {
  return png(picture.size(), AV_PIX_FMT_RGB24, [&](int y, std::uint8_t* to) {
    std::memcpy(to, picture.row(y), static_cast<std::size_t>(picture.width()) * sizeof(Rgb8));
  });
}

std::string png_of(View<const std::uint8_t> picture) {
  return png(picture.size(), AV_PIX_FMT_GRAY8,
             [&](int y, std::uint8_t* to) { std::copy_n(picture.row(y), picture.width(), to); });
}

std::string png_of(View<const std::uint16_t> picture) {
  return png(picture.size(), AV_PIX_FMT_GRAY16BE, [&](int y, std::uint8_t* to) {
    for (int x = 0; x < picture.width(); ++x) {
      const std::uint16_t value = picture.row(y)[x];
      *to++ = static_cast<std::uint8_t>(value >> 8);
      *to++ = static_cast<std::uint8_t>(value);
    }
  });
}

std::string jpeg_of(View<const Rgb8> picture, int quality) {
  if (picture.empty()) return {};
  const std::unique_ptr<void, int (*)(tjhandle)> encoder(av::had_memory(tjInitCompress()), tjDestroy);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const int failed = tjCompress2(encoder.get(), reinterpret_cast<const unsigned char*>(picture.data()), picture.width(),
                                 static_cast<int>(picture.stride()) * static_cast<int>(sizeof(Rgb8)), picture.height(),
                                 TJPF_RGB, &bytes, &size, TJSAMP_420, quality, TJFLAG_ACCURATEDCT);
  std::string out;
  if (failed == 0) out.assign(reinterpret_cast<const char*>(bytes), size);
  tjFree(bytes);
  return out;
}

}  // namespace duo
