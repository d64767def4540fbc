#include "sinks/video_writer.h"

#include <fmt/format.h>

#include "core/libav_file.h"

extern "C" {
#include <libavutil/opt.h>
}

namespace duo {
namespace {

/// An opened encoder, or none where this libav lacks the codec or refuses it.
av::Coder open_encoder(AVCodecID id, Size size, AVRational rate) {
  const AVCodec* codec = id == AV_CODEC_ID_H264 ? avcodec_find_encoder_by_name("libx264") : avcodec_find_encoder(id);
  av::Coder encoder(codec != nullptr ? avcodec_alloc_context3(codec) : nullptr);
  if (!encoder) return nullptr;
  encoder->width = size.width;
  encoder->height = size.height;
  encoder->pix_fmt = AV_PIX_FMT_YUV420P;
  encoder->color_range = AVCOL_RANGE_MPEG;
  encoder->colorspace = AVCOL_SPC_BT709;
  encoder->color_primaries = AVCOL_PRI_BT709;
  encoder->color_trc = AVCOL_TRC_BT709;
  encoder->framerate = rate;
  encoder->time_base = av_inv_q(rate);
  encoder->thread_count = 1;
  encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_BITEXACT;
  if (id == AV_CODEC_ID_H264) {
    av_opt_set(encoder->priv_data, "preset", "superfast", 0);
    av_opt_set(encoder->priv_data, "crf", "23", 0);
  } else {
    encoder->flags |= AV_CODEC_FLAG_QSCALE;
    encoder->global_quality = 3 * FF_QP2LAMBDA;
  }
  if (avcodec_open2(encoder.get(), codec, nullptr) < 0) return nullptr;
  return encoder;
}

}  // namespace

Error VideoWriter::failed(int error) const {
  return {is_exhausted(AVUNERROR(error)) ? ErrorCode::kExhausted : ErrorCode::kWriteFailed,
          fmt::format("cannot write video '{}': {}; free some space or write elsewhere", name_, av::reason(error))};
}

Result<VideoWriter> VideoWriter::open(const std::filesystem::path& path, Size size, double frame_s) {
  av_log_set_level(AV_LOG_QUIET);  // what is wrong is said in our results
  DUO_TRY_ASSIGN(PartialFile file, PartialFile::open(path));
  VideoWriter video(std::move(file), shown(path).string());
  DUO_TRY(video.prepare(size, frame_s));
  return video;
}

Result<void> VideoWriter::prepare(Size size, double frame_s) {
  constexpr int kFinest = 60000;  // holds 30000/1001 and makes 30/1 of a time rounded to nanoseconds
  const AVRational rate = av_d2q(1 / frame_s, kFinest);
  encoder_ = open_encoder(AV_CODEC_ID_H264, size, rate);
  if (!encoder_) encoder_ = open_encoder(AV_CODEC_ID_MPEG4, size, rate);
  if (!encoder_)
    return Error{ErrorCode::kUnsupported,
                 fmt::format("cannot write video '{}': libav has no encoder for H.264 or MPEG-4 of {}x{}; "
                             "install libx264",
                             name_, size.width, size.height)};
  frame_.reset(av_frame_alloc());
  packet_.reset(av_packet_alloc());
  if (!frame_ || !packet_) return failed(AVERROR(ENOMEM));
  frame_->format = encoder_->pix_fmt;
  frame_->width = size.width;
  frame_->height = size.height;
  frame_->pts = 0;
  if (const int e = av_frame_get_buffer(frame_.get(), 0); e < 0) return failed(e);
  constexpr int kFlags = SWS_BILINEAR | SWS_ACCURATE_RND | SWS_BITEXACT;
  scaler_.reset(sws_getContext(size.width, size.height, AV_PIX_FMT_RGB24, size.width, size.height, encoder_->pix_fmt, kFlags,
                               nullptr, nullptr, nullptr));
  if (!scaler_) return failed(AVERROR(ENOMEM));
  constexpr int kOne = 1 << 16;
  sws_setColorspaceDetails(scaler_.get(), sws_getCoefficients(SWS_CS_DEFAULT), 1, sws_getCoefficients(SWS_CS_ITU709), 0, 0,
                           kOne, kOne);

  AVFormatContext* muxer = nullptr;
  if (const int e = avformat_alloc_output_context2(&muxer, nullptr, "mp4", nullptr); e < 0) return failed(e);
  muxer_.reset(muxer);
  muxer->flags |= AVFMT_FLAG_BITEXACT;                        // no date inside
  av_opt_set(muxer->priv_data, "movflags", "+faststart", 0);  // the index in front: it plays while it loads
  AVStream* stream = avformat_new_stream(muxer, nullptr);
  if (stream == nullptr) return failed(AVERROR(ENOMEM));
  stream->time_base = encoder_->time_base;
  stream->avg_frame_rate = rate;
  if (const int e = avcodec_parameters_from_context(stream->codecpar, encoder_.get()); e < 0) return failed(e);
  if (const int e = av::write_into(*muxer, file_.fd()); e < 0) return failed(e);
  if (const int e = avformat_write_header(muxer, nullptr); e < 0) return failed(e);
  return {};
}

Result<void> VideoWriter::encode(const AVFrame* frame) {
  if (const int e = avcodec_send_frame(encoder_.get(), frame); e < 0) return failed(e);
  for (;;) {
    const int received = avcodec_receive_packet(encoder_.get(), packet_.get());
    if (received == AVERROR(EAGAIN) || received == AVERROR_EOF) return {};
    if (received < 0) return failed(received);
    if (packet_->duration == 0) packet_->duration = 1;
    av_packet_rescale_ts(packet_.get(), encoder_->time_base, muxer_->streams[0]->time_base);
    if (const int e = av_interleaved_write_frame(muxer_.get(), packet_.get()); e < 0) return failed(e);
  }
}

Result<void> VideoWriter::write(View<const Rgb8> picture) {
  if (const int e = av_frame_make_writable(frame_.get()); e < 0) return failed(e);  // the encoder may still hold the last one
  const std::uint8_t* planes[4] = {reinterpret_cast<const std::uint8_t*>(picture.data())};
  const int strides[4] = {static_cast<int>(picture.stride() * 3)};
  sws_scale(scaler_.get(), planes, strides, 0, picture.height(), frame_->data, frame_->linesize);
  DUO_TRY(encode(frame_.get()));
  ++frame_->pts;
  return {};
}

Result<void> VideoWriter::finish() {
  DUO_TRY(encode(nullptr));
  if (const int e = av_write_trailer(muxer_.get()); e < 0) return failed(e);
  if (const int e = av::flush(*muxer_); e < 0) return failed(e);
  return file_.publish();
}

}  // namespace duo
