// Depth as FFV1 of 16 bits in Matroska, through libav.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/file.h"
#include "core/libav_file.h"
#include "duoptic/frame_files.h"

namespace duo {

struct DepthVideo::State {
  State(PartialFile into, std::string of) : file(std::move(into)), name(std::move(of)) {}
  Result<void> prepare(Size size, double frame_s);
  Result<void> encode(const AVFrame* picture);
  Error failed(int error) const { return write_error(name, AVUNERROR(error)); }

  PartialFile file;
  std::string name;
  av::Muxer muxer;
  av::Coder encoder;
  av::CodedFrame frame;
  av::Packet packet;
  std::int64_t last_ms = -1, frame_ms = 0;
};

Result<void> DepthVideo::State::prepare(Size size, double frame_s) {
  constexpr AVRational kDepthMs = {1, 1000};
  constexpr int kFinest = 60000;  // as in recordings
  const AVCodec* codec = avcodec_find_encoder(AV_CODEC_ID_FFV1);
  encoder.reset(codec != nullptr ? avcodec_alloc_context3(codec) : nullptr);
  if (encoder) {
    encoder->width = size.width;
    encoder->height = size.height;
    encoder->pix_fmt = AV_PIX_FMT_GRAY16LE;
    encoder->time_base = kDepthMs;
    encoder->level = 3;  // of FFV1: with checksums
    encoder->gop_size = 1;
    encoder->thread_count = 1;
    encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_BITEXACT;
  }
  if (!encoder || avcodec_open2(encoder.get(), codec, nullptr) < 0)
    return Error{ErrorCode::kUnsupported,
                 fmt::format("cannot write depth video '{}': libav has no encoder for FFV1 of 16 bits here; write depth.png of "
                             "each frame (--outputs depth)",
                             name)};
  frame.reset(av_frame_alloc());
  packet.reset(av_packet_alloc());
  if (!frame || !packet) return failed(AVERROR(ENOMEM));
  frame->format = encoder->pix_fmt;
  frame->width = size.width;
  frame->height = size.height;
  if (const int e = av_frame_get_buffer(frame.get(), 0); e < 0) return failed(e);

  AVFormatContext* made = nullptr;
  if (const int e = avformat_alloc_output_context2(&made, nullptr, "matroska", nullptr); e < 0) return failed(e);
  muxer.reset(made);
  muxer->flags |= AVFMT_FLAG_BITEXACT;
  AVStream* stream = avformat_new_stream(made, nullptr);
  if (stream == nullptr) return failed(AVERROR(ENOMEM));
  stream->time_base = kDepthMs;
  stream->avg_frame_rate = av_d2q(1 / frame_s, kFinest);
  av_dict_set(&stream->metadata, "title", "depth in mm, 0 = none", 0);
  if (const int e = avcodec_parameters_from_context(stream->codecpar, encoder.get()); e < 0) return failed(e);
  if (const int e = av::write_into(*made, file.fd()); e < 0) return failed(e);
  if (const int e = avformat_write_header(made, nullptr); e < 0) return failed(e);
  frame_ms = std::llround(1000 * frame_s);
  return {};
}

Result<void> DepthVideo::State::encode(const AVFrame* picture) {
  if (const int e = avcodec_send_frame(encoder.get(), picture); e < 0) return failed(e);
  for (;;) {
    const int received = avcodec_receive_packet(encoder.get(), packet.get());
    if (received == AVERROR(EAGAIN) || received == AVERROR_EOF) return {};
    if (received < 0) return failed(received);
    packet->duration = frame_ms;
    av_packet_rescale_ts(packet.get(), encoder->time_base, muxer->streams[0]->time_base);
    if (const int e = av_interleaved_write_frame(muxer.get(), packet.get()); e < 0) return failed(e);
  }
}

DepthVideo::DepthVideo(std::unique_ptr<State> state) : state_(std::move(state)) {}
DepthVideo::DepthVideo(DepthVideo&&) noexcept = default;
DepthVideo& DepthVideo::operator=(DepthVideo&&) noexcept = default;
DepthVideo::~DepthVideo() = default;

Result<DepthVideo> DepthVideo::open(const std::filesystem::path& path, Size size, double frame_s) {
  av_log_set_level(AV_LOG_QUIET);  // what is wrong is said in our results
  DUO_TRY_ASSIGN(PartialFile file, PartialFile::open(path));
  auto state = std::make_unique<State>(std::move(file), shown(path).string());
  DUO_TRY(state->prepare(size, frame_s));
  return DepthVideo(std::move(state));
}

Result<void> DepthVideo::write(View<const std::uint16_t> depth_mm, double t_s) {
  State& s = *state_;
  if (const int e = av_frame_make_writable(s.frame.get()); e < 0) return s.failed(e);
  for (int y = 0; y < depth_mm.height(); ++y)
    std::memcpy(s.frame->data[0] + y * s.frame->linesize[0], depth_mm.row(y),
                sizeof(std::uint16_t) * static_cast<std::size_t>(depth_mm.width()));
  s.last_ms = std::max<std::int64_t>(s.last_ms + 1, std::llround(1000 * t_s));
  s.frame->pts = s.last_ms;
  return s.encode(s.frame.get());
}

Result<void> DepthVideo::finish() {
  State& s = *state_;
  DUO_TRY(s.encode(nullptr));
  if (const int e = av_write_trailer(s.muxer.get()); e < 0) return s.failed(e);
  if (const int e = av::flush(*s.muxer); e < 0) return s.failed(e);
  return s.file.publish();
}

}  // namespace duo
