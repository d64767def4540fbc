#include "sources/stream_input.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "sources/picture_bytes.h"

namespace duo {
namespace {

constexpr auto kOpening = std::chrono::seconds(5), kReading = std::chrono::seconds(2);

// What an address may answer with: nothing that names other addresses (play lists, session descriptions).
constexpr char kHttpFormats[] = "mpjpeg,mjpeg,jpeg_pipe,png_pipe,matroska,webm,mpegts,mpeg,mov,mp4,flv,avi,h264,hevc,m4v";
constexpr char kRtspFormats[] = "rtsp", kPipeFormats[] = "yuv4mpegpipe";
constexpr char kNoProtocol[] = "-", kRtspProtocols[] = "rtsp,tcp";

int open_nothing(AVFormatContext*, AVIOContext**, const char*, int, AVDictionary**) { return AVERROR(EPERM); }

}  // namespace

/// libav asks while it connects and before each read: from then on it may connect to nothing else, wherever it is sent.
int StreamInput::is_over(void* self) {
  auto& input = *static_cast<StreamInput*>(self);
  if (input.opening_ != nullptr && input.opening_->protocol_whitelist != nullptr)
    input.opening_->protocol_whitelist[0] = kNoProtocol[0], input.opening_->protocol_whitelist[1] = '\0';
  return input.is_over() ? 1 : 0;
}

void StreamInput::allow(std::chrono::nanoseconds time) {
  until_ = std::chrono::steady_clock::now() + time;
  bytes_left_ = most_bytes_;
}

int StreamInput::read(void* self, std::uint8_t* into, int size) {
  auto& input = *static_cast<StreamInput*>(self);
  if (input.bytes_left_ <= 0) return AVERROR(EFBIG);
  const int n = input.read_(into, size);
  if (n <= 0) return n < 0 ? n : input.is_over() ? AVERROR_EXIT : AVERROR_EOF;
  input.bytes_left_ -= n;
  return n;
}

int StreamInput::read_pipe(std::uint8_t* into, int size) {
  constexpr int kStep_ms = 20;
  while (!is_over()) {
    const ssize_t n = ::read(gst_.pictures_fd(), into, static_cast<std::size_t>(size));
    if (n >= 0) return static_cast<int>(n);
    if (errno != EAGAIN && errno != EINTR) return AVERROR(errno);
    pollfd one{gst_.pictures_fd(), POLLIN, 0};
    ::poll(&one, 1, kStep_ms);
  }
  return AVERROR_EXIT;
}

/// `url` empty: from bytes_.
std::string StreamInput::open_container(const char* url, const char* formats, const char* format) {
  av::Container opening(avformat_alloc_context());
  if (!opening || !frame_ || !packet_ || !av::allow_only(*opening, formats, *url != '\0' ? kRtspProtocols : kNoProtocol))
    return "out of memory";
  AVFormatContext* context = opening.release();
  context->interrupt_callback = {is_over, this};
  context->io_open = open_nothing;
  context->pb = bytes_.get();
  context->fps_probe_size = 0;  // no wait for a rate to be measured
  opening_ = *url != '\0' ? context : nullptr;
  AVDictionary* options = nullptr;
  av_dict_set(&options, "rtsp_transport", "tcp", 0);  // UDP loses parts of pictures
  // Frees the context itself when it fails.
  const int opened = avformat_open_input(&context, url, av_find_input_format(format), &options);
  opening_ = nullptr;
  av_dict_free(&options);
  if (opened == AVERROR(EFBIG)) return "its pictures are too large";
  if (opened < 0) return av::reason(opened);
  container_.reset(context);
  if (const int e = av::find_streams(*context); e < 0) return av::reason(e);
  return open_decoder();
}

std::string StreamInput::open_decoder() {
  stream_ = av_find_best_stream(container_.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (stream_ < 0) return "it holds no video";
  AVStream& stream = *container_->streams[stream_];
  for (unsigned i = 0; i < container_->nb_streams; ++i)
    container_->streams[i]->discard = static_cast<int>(i) == stream_ ? AVDISCARD_DEFAULT : AVDISCARD_ALL;
  if (const std::string why = av::too_many_pixels({stream.codecpar->width, stream.codecpar->height}); !why.empty()) return why;
  decoder_ = av::open_decoder(stream.codecpar->codec_id, [&](AVCodecContext& decoder) {
    decoder.pkt_timebase = stream.time_base;
    decoder.flags |= AV_CODEC_FLAG_LOW_DELAY;
    return avcodec_parameters_to_context(&decoder, stream.codecpar) >= 0;
  });
  if (!decoder_) return fmt::format("no decoder for {}", avcodec_get_name(stream.codecpar->codec_id));
  // Only a pipeline's head says its rate; what libav makes of other streams is a guess.
  const AVRational rate = stream.avg_frame_rate;
  const bool said = std::strcmp(container_->iformat->name, "yuv4mpegpipe") == 0 && rate.num > 0 && rate.den > 0;
  const double frame_s = said ? av_q2d(av_inv_q(rate)) : 0;
  constexpr double kLeast_s = 0.001, kMost_s = 1;
  frame_s_ = frame_s >= kLeast_s && frame_s <= kMost_s ? frame_s : 0;
  return {};
}

std::string StreamInput::open(const std::string& name) {
  allow(kOpening);
  const std::string why = connect(name);
  return !why.empty() && is_over() ? "nothing comes from it" : why;
}

std::string StreamInput::connect(const std::string& name) {
  if (name.starts_with("rtsp://")) return open_container(name.c_str(), kRtspFormats, "rtsp");
  if (!name.starts_with(kGstPrefix)) {
    const std::string why = http_.open(name);
    return why.empty() ? open_web([this](std::uint8_t* into, int size) { return http_.read(into, size); }, http_.kind()) : why;
  }
  if (std::string why = gst_.start(name.substr(sizeof kGstPrefix - 1)); !why.empty()) return why;
  const std::string why = open_pipeline([this](std::uint8_t* into, int size) { return read_pipe(into, size); });
  const std::string complaint = why.empty() ? "" : gst_.complaint();
  return complaint.empty() ? why : complaint;
}

std::string StreamInput::open_web(Read read, const std::string& kind) {
  constexpr std::int64_t kMost = 64 << 20;
  return open_bytes(std::move(read), kMost, kHttpFormats, kind.starts_with("multipart/x-mixed-replace") ? "mpjpeg" : "");
}

std::string StreamInput::open_pipeline(Read read) {
  constexpr std::int64_t kPixelBytes = 4;
  return open_bytes(std::move(read), kPixelBytes * av::most_pixels(), kPipeFormats, "yuv4mpegpipe");
}

std::string StreamInput::open_bytes(Read read, std::int64_t most, const char* formats, const char* format) {
  constexpr int kBuffer = 1 << 16;
  read_ = std::move(read);
  most_bytes_ = bytes_left_ = most;
  auto* buffer = static_cast<unsigned char*>(av_malloc(kBuffer));
  bytes_.reset(buffer == nullptr ? nullptr : avio_alloc_context(buffer, kBuffer, 0, this, StreamInput::read, nullptr, nullptr));
  if (!bytes_) return av_free(buffer), "out of memory";
  return open_container("", formats, format);
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
        avcodec_send_packet(decoder_.get(), packet_.get()) >= 0)
      put_jpeg(decoder_->codec_id == AV_CODEC_ID_MJPEG ? av::bytes_of(*packet_) : std::string_view(), into);
    av_packet_unref(packet_.get());
  }
}

}  // namespace duo
