#include "sinks/coded_view.h"

#include <algorithm>

extern "C" {
#include <libavutil/opt.h>
}

namespace duo {
namespace {

/// FFV1 version 3: four slices, each with a checksum, on two threads; every picture a key picture.
av::Coder open_ffv1(Size size) {
  const AVCodec* codec = avcodec_find_encoder(AV_CODEC_ID_FFV1);
  if (codec == nullptr) return nullptr;
  av::Coder encoder(av::had_memory(avcodec_alloc_context3(codec)));
  encoder->width = size.width;
  encoder->height = size.height;
  encoder->pix_fmt = AV_PIX_FMT_0RGB32;
  encoder->time_base = {1, 1000};
  encoder->gop_size = 1;
  encoder->level = 3;
  encoder->slices = 4;
  encoder->thread_count = 2;
  encoder->thread_type = FF_THREAD_SLICE;
  encoder->flags |= AV_CODEC_FLAG_BITEXACT;
  av_opt_set_int(encoder->priv_data, "slicecrc", 1, 0);
  if (av::had_memory(avcodec_open2(encoder.get(), codec, nullptr)) < 0) return nullptr;
  return encoder;
}

}  // namespace

Result<CodedView> CodedView::open(const Picture& first) {
  CodedView view;
  view.size_ = first.pixels.size();
  if (!first.jpeg.empty()) return view;
  view.encoder_ = open_ffv1(view.size_);
  view.frame_.reset(av::had_memory(av_frame_alloc()));
  if (!view.encoder_)
    return Error{ErrorCode::kUnsupported, "cannot record: this libav has no encoder for FFV1; install Debian's libavcodec59"};
  view.frame_->format = view.encoder_->pix_fmt;
  view.frame_->width = view.size_.width;
  view.frame_->height = view.size_.height;
  view.frame_->pts = 0;
  av::had_memory(av_frame_get_buffer(view.frame_.get(), 0));
  return view;
}

bool CodedView::describe(AVCodecParameters& parameters) const {
  if (encoder_) return avcodec_parameters_from_context(&parameters, encoder_.get()) >= 0;
  parameters.codec_type = AVMEDIA_TYPE_VIDEO;
  parameters.codec_id = AV_CODEC_ID_MJPEG;
  parameters.width = size_.width;
  parameters.height = size_.height;
  return true;
}

av::Packet CodedView::code(const Picture& picture) {
  av::Packet packet(av::had_memory(av_packet_alloc()));
  if (picture.pixels.size() != size_) return nullptr;
  if (!encoder_) {
    const std::vector<std::uint8_t>& jpeg = picture.jpeg;
    if (jpeg.empty() || av::had_memory(av_new_packet(packet.get(), static_cast<int>(jpeg.size()))) < 0) return nullptr;
    std::copy(jpeg.begin(), jpeg.end(), packet->data);
    return packet;
  }
  if (av::had_memory(av_frame_make_writable(frame_.get())) < 0) return nullptr;
  for (int y = 0; y < size_.height; ++y) {
    const Rgb8* src = picture.pixels.row(y);
    auto* dst = reinterpret_cast<std::uint32_t*>(frame_->data[0] + std::ptrdiff_t{y} * frame_->linesize[0]);
    for (int x = 0; x < size_.width; ++x)
      dst[x] = std::uint32_t{src[x].r} << 16 | std::uint32_t{src[x].g} << 8 | std::uint32_t{src[x].b};
  }
  const bool coded = av::had_memory(avcodec_send_frame(encoder_.get(), frame_.get())) >= 0 &&
                     av::had_memory(avcodec_receive_packet(encoder_.get(), packet.get())) >= 0;
  ++frame_->pts;
  return coded ? std::move(packet) : nullptr;
}

}  // namespace duo
