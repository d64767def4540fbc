#include "sources/stream_input.h"

#include <fmt/format.h>

namespace duo {
namespace {

constexpr auto kOpening = std::chrono::seconds(5), kReading = std::chrono::seconds(2);
// No files: what a server sends must not reach them.
constexpr char kProtocols[] = "http,https,rtsp,rtp,udp,tcp,tls,crypto,httpproxy,pipe";

}  // namespace

int StreamInput::is_over(void* self) {
  const auto& input = *static_cast<const StreamInput*>(self);
  return input.unwanted_() || std::chrono::steady_clock::now() > input.until_ ? 1 : 0;
}

std::string StreamInput::open_container(const char* url, const AVInputFormat* format) {
  AVFormatContext* context = avformat_alloc_context();
  if (context == nullptr || !frame_ || !packet_) return "out of memory";
  context->interrupt_callback = {is_over, this};
  context->protocol_whitelist = av_strdup(kProtocols);
  context->fps_probe_size = 0;  // no wait for a rate to be measured
  AVDictionary* options = nullptr;
  av_dict_set(&options, "rtsp_transport", "tcp", 0);  // UDP loses parts of pictures
  // Frees the context itself when it fails.
  const int opened = avformat_open_input(&context, url, format, &options);
  av_dict_free(&options);
  if (opened < 0) return av::reason(opened);
  container_.reset(context);
  if (const int e = avformat_find_stream_info(context, nullptr); e < 0) return av::reason(e);
  stream_ = av_find_best_stream(context, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (stream_ < 0) return "it holds no video";
  AVStream& stream = *context->streams[stream_];
  for (unsigned i = 0; i < context->nb_streams; ++i)
    context->streams[i]->discard = static_cast<int>(i) == stream_ ? AVDISCARD_DEFAULT : AVDISCARD_ALL;
  decoder_ = av::open_decoder(stream.codecpar->codec_id, [&](AVCodecContext& decoder) {
    decoder.pkt_timebase = stream.time_base;
    decoder.flags |= AV_CODEC_FLAG_LOW_DELAY;
    return avcodec_parameters_to_context(&decoder, stream.codecpar) >= 0;
  });
  if (!decoder_) return fmt::format("no decoder for {}", avcodec_get_name(stream.codecpar->codec_id));
  rate_hz_ = av_q2d(av_guess_frame_rate(context, &stream, nullptr));
  return {};
}

std::string StreamInput::open(const std::string& name) {
  allow(kOpening);
  const std::string why = connect(name);
  return !why.empty() && is_over(this) != 0 ? "nothing comes from it" : why;
}

std::string StreamInput::connect(const std::string& name) {
  if (!name.starts_with(kGstPrefix)) return open_container(name.c_str(), nullptr);
  if (std::string why = gst_.start(name.substr(sizeof kGstPrefix - 1)); !why.empty()) return why;
  const std::string pipe = fmt::format("pipe:{}", gst_.pictures_fd());
  const std::string why = open_container(pipe.c_str(), av_find_input_format("yuv4mpegpipe"));
  const std::string complaint = why.empty() ? "" : gst_.complaint();
  return complaint.empty() ? why : complaint;
}

bool StreamInput::next(Picture& into) {
  allow(kReading);
  while (true) {
    const int received = avcodec_receive_frame(decoder_.get(), frame_.get());
    if (received >= 0 && !av::is_damaged(*frame_)) return to_rgb_.convert(*frame_, into.pixels);
    if (received >= 0) continue;  // a part of it was lost on the way
    if (received != AVERROR(EAGAIN)) return false;
    if (av_read_frame(container_.get(), packet_.get()) < 0) return false;
    if (packet_->stream_index == stream_ && (packet_->flags & AV_PKT_FLAG_CORRUPT) == 0 &&
        avcodec_send_packet(decoder_.get(), packet_.get()) >= 0) {
      into.jpeg.clear();
      if (decoder_->codec_id == AV_CODEC_ID_MJPEG) into.jpeg.assign(packet_->data, packet_->data + packet_->size);
    }
    av_packet_unref(packet_.get());
  }
}

}  // namespace duo
