#include "sources/camera/decode.h"

#include <algorithm>
#include <cstring>

#include "sources/picture_bytes.h"

namespace duo {
namespace {

using namespace std::string_view_literals;

av::Decoder jpeg_decoder() {
  av_log_set_level(AV_LOG_QUIET);  // what is lost is counted
  return av::open_decoder(AV_CODEC_ID_MJPEG, [](AVCodecContext& context) {
    context.err_recognition = AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER | AV_EF_EXPLODE;
    return true;
  });
}

}  // namespace

bool CameraDecoder::is_known(std::uint32_t code) { return std::find(kFourccs.begin(), kFourccs.end(), code) != kFourccs.end(); }

CameraDecoder::Outcome CameraDecoder::decode(const CameraFormat& format, std::string_view bytes, Picture& into) {
  return is_raw(format.fourcc) ? decode_raw(format, bytes, into) : decode_jpeg(format, bytes, into);
}

CameraDecoder::Outcome CameraDecoder::decode_raw(const CameraFormat& format, std::string_view bytes, Picture& into) {
  // NV12: a byte of brightness for each pixel, then a row of colour, two bytes for two pixels, for each two rows.
  const bool nv12 = format.fourcc == fourcc_of("NV12");
  const auto width = static_cast<std::size_t>(format.size.width), height = static_cast<std::size_t>(format.size.height);
  const std::size_t row_bytes = nv12 ? (width + 1) / 2 * 2 : 2 * width, rows = nv12 ? height + (height + 1) / 2 : height;
  const std::size_t stride = std::max(static_cast<std::size_t>(std::max(format.stride_bytes, 0)), row_bytes);
  const std::size_t size = stride * (rows - 1) + row_bytes;
  if (!frame_ || bytes.size() < size) return Outcome::kDamaged;
  raw_.resize(size + av::ToRgb::kReadBeyond);
  std::memcpy(raw_.data(), bytes.data(), size);
  av_frame_unref(frame_.get());
  frame_->format = nv12 ? AV_PIX_FMT_NV12 : format.fourcc == fourcc_of("UYVY") ? AV_PIX_FMT_UYVY422 : AV_PIX_FMT_YUYV422;
  frame_->width = format.size.width;
  frame_->height = format.size.height;
  frame_->colorspace = AVCOL_SPC_SMPTE170M;
  frame_->color_range = AVCOL_RANGE_MPEG;
  frame_->data[0] = raw_.data();
  frame_->data[1] = nv12 ? frame_->data[0] + stride * height : nullptr;
  frame_->linesize[0] = static_cast<int>(stride);
  frame_->linesize[1] = nv12 ? static_cast<int>(stride) : 0;
  put_jpeg({}, into);
  return to_rgb_.convert(*frame_, into.pixels) ? Outcome::kWhole : Outcome::kDamaged;
}

CameraDecoder::Outcome CameraDecoder::decode_jpeg(const CameraFormat& format, std::string_view bytes, Picture& into) {
  // A buffer may go on after the picture; one without the end mark is cut, whatever a decoder makes of it.
  const std::size_t end = bytes.rfind("\xff\xd9"sv);
  if (end == std::string_view::npos || !bytes.starts_with("\xff\xd8"sv)) return Outcome::kDamaged;
  if (!jpeg_) jpeg_ = jpeg_decoder();
  if (!jpeg_ || !packet_ || !frame_) return Outcome::kDamaged;
  av_packet_unref(packet_.get());
  if (av_new_packet(packet_.get(), static_cast<int>(end + 2)) < 0) return Outcome::kDamaged;
  std::memcpy(packet_->data, bytes.data(), end + 2);
  const bool whole = avcodec_send_packet(jpeg_.get(), packet_.get()) >= 0 &&
                     avcodec_receive_frame(jpeg_.get(), frame_.get()) >= 0 && !av::is_damaged(*frame_);
  if (!whole) {
    avcodec_flush_buffers(jpeg_.get());
    return Outcome::kDamaged;
  }
  if (Size{frame_->width, frame_->height} != format.size) return Outcome::kOtherSize;
  put_jpeg(av::bytes_of(*packet_), into);
  return to_rgb_.convert(*frame_, into.pixels) ? Outcome::kWhole : Outcome::kDamaged;
}

}  // namespace duo
