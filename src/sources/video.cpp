#include "sources/video.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string>

#include "core/capture_mark.h"
#include "core/file.h"
#include "sources/libav.h"

namespace duo {
namespace {

// Containers that hold nothing but their own bytes: play lists and the like could reach other files or the network.
constexpr char kContainers[] = "avi,matroska,webm,mov,mp4,mpegts,mpeg";

Error unreadable(const std::filesystem::path& path, int error, const std::string& why) {
  return av::input_error("video " + path.string(), error, why);
}

class VideoFile final : public Source {
 public:
  Result<void> open(const std::filesystem::path& path, std::optional<int> track);
  Size size() const override { return size_; }
  std::int64_t count() const override { return announced_; }
  bool still() const override { return false; }
  double frame_s() const override { return static_cast<double>(frame_ns()) * 1e-9; }
  Result<Next> next(Picture& into) override;

 private:
  enum class Decoded { kFrame, kEnd, kCut };
  Decoded decode();
  Decoded end_of_file() const;
  void fail(int error) {
    if (is_exhausted(AVUNERROR(error)) && error != AVERROR(EAGAIN)) failure_ = error;
  }
  bool follows();
  std::int64_t announced_packets() const;
  TimeNs announced_end_ns() const;
  TimeNs frame_ns() const {
    if (recorded_frame_ns_ > 0) return recorded_frame_ns_;
    const AVRational rate = stream().avg_frame_rate;
    return rate.num > 0 && rate.den > 0 ? std::max<TimeNs>(av::to_ns(1, av_inv_q(rate)), 1) : 33'333'333;
  }
  const AVStream& stream() const { return *container_->streams[stream_]; }

  std::string name_;
  av::Container container_;
  av::Decoder decoder_;
  av::DecodedFrame frame_{av_frame_alloc()};
  av::Packet packet_{av_packet_alloc()};
  av::Packet sent_{av_packet_alloc()};  // the last one the decoder got: frame_'s where each packet is a picture
  av::ToRgb to_rgb_;
  int stream_ = -1;
  Size size_;
  std::int64_t announced_ = 0;    // packets; 0 = not announced
  std::int64_t packets_ = 0;      // whole ones read so far
  TimeNs shown_ns_ = 0;           // time of the last picture decoded
  TimeNs recorded_frame_ns_ = 0;  // of our own recordings: from picture to picture; 0: not one
  TimeNs end_ns_ = 0;             // where the last packet ends
  std::uint64_t given_ = 0;
  int failure_ = 0;       // libav's, where it is not the file's fault
  bool drained_ = false;  // the decoder was told that nothing follows
  bool cut_ = false;
  bool pending_ = false;  // frame_ holds a picture that next() has not given yet
};

/// Number `track` of the video streams, or the best of them; below 0 when there is none.
int video_stream(AVFormatContext* container, std::optional<int> track) {
  if (!track) return av_find_best_stream(container, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  for (unsigned i = 0; i < container->nb_streams; ++i)
    if (container->streams[i]->codecpar->codec_type == AVMEDIA_TYPE_VIDEO &&
        (container->streams[i]->disposition & AV_DISPOSITION_ATTACHED_PIC) == 0 && (*track)-- == 0)
      return static_cast<int>(i);
  return -1;
}

Result<void> VideoFile::open(const std::filesystem::path& path, std::optional<int> track) {
  name_ = path.string();
  if (!frame_ || !packet_ || !sent_) return unreadable(path, AVERROR(ENOMEM), "");
  av::Container opening(avformat_alloc_context());
  if (!opening || !av::allow_only(*opening, kContainers, "file")) return unreadable(path, AVERROR(ENOMEM), "");
  AVFormatContext* context = opening.release();
  // Frees the context itself when it fails.
  if (const int e = avformat_open_input(&context, ("file:" + name_).c_str(), nullptr, nullptr); e < 0)
    return unreadable(path, e, "it is no picture or video that can be read, or it was cut before its index was written");
  container_.reset(context);
  if (const int e = av::find_streams(*context); e < 0) return unreadable(path, e, av::reason(e));
  stream_ = video_stream(context, track);
  if (stream_ < 0) return unreadable(path, 0, "it holds no video");
  if (const std::string why = av::too_many_pixels({stream().codecpar->width, stream().codecpar->height}); !why.empty())
    return unreadable(path, 0, why);
  for (unsigned i = 0; i < context->nb_streams; ++i)
    context->streams[i]->discard = static_cast<int>(i) == stream_ ? AVDISCARD_DEFAULT : AVDISCARD_ALL;
  decoder_ = av::open_decoder(stream().codecpar->codec_id, [this](AVCodecContext& decoder) {
    decoder.pkt_timebase = stream().time_base;
    return avcodec_parameters_to_context(&decoder, stream().codecpar) >= 0;
  });
  if (!decoder_)
    return Error{ErrorCode::kUnsupported,
                 fmt::format("cannot read video {}: no decoder for {}", name_, avcodec_get_name(stream().codecpar->codec_id))};
  recorded_frame_ns_ = CaptureMark::frame_ns(*context);
  announced_ = announced_packets();
  if (decode() != Decoded::kFrame) return unreadable(path, failure_, "no whole picture at its start");
  pending_ = true;
  size_ = {frame_->width, frame_->height};
  return {};
}

/// What the container says of its length: exact in AVI's header and MP4's index.
std::int64_t VideoFile::announced_packets() const {
  const bool indexed = std::strstr(container_->iformat->name, "mp4") != nullptr;
  // MP4: the index that the demuxer keeps leaves out what an edit list cuts away; nb_frames does not.
  const std::int64_t in_index = indexed ? avformat_index_get_entries_count(&stream()) : 0;
  return in_index > 0 ? in_index : std::max<std::int64_t>(stream().nb_frames, 0);
}

/// Where the video stream should end by the container's durations; 0 when it does not say.
TimeNs VideoFile::announced_end_ns() const {
  const AVStream& s = stream();
  const TimeNs start = av::to_ns(s.start_time, s.time_base);
  if (s.duration > 0) return start + av::to_ns(s.duration, s.time_base);
  if (std::strstr(container_->iformat->name, "matroska") == nullptr) return 0;  // elsewhere an estimate from the file size
  if (const AVDictionaryEntry* tag = av_dict_get(s.metadata, "DURATION", nullptr, 0); tag != nullptr) {
    int hours = 0, minutes = 0;
    double seconds = 0;
    if (std::sscanf(tag->value, "%d:%d:%lf", &hours, &minutes, &seconds) == 3) {
      const double end_s = hours * 3600.0 + minutes * 60.0 + seconds;
      return end_s > 0 && end_s * 1e9 < CaptureMark::kMost_ns ? std::llround(end_s * 1e9) : 0;
    }
  }
  // The container's own duration is the longest stream's: ours only when it is alone.
  return container_->nb_streams == 1 && container_->duration > 0 ? start + av::to_ns(container_->duration, AV_TIME_BASE_Q) : 0;
}

VideoFile::Decoded VideoFile::end_of_file() const {
  if (cut_ || packets_ < announced_) return Decoded::kCut;
  const TimeNs announced_end = announced_ > 0 ? 0 : announced_end_ns();
  // A recording says its length when it is finished.
  if (recorded_frame_ns_ > 0 && announced_end == 0) return Decoded::kCut;
  // Half a picture of tolerance: containers round durations to milliseconds.
  return announced_end > 0 && end_ns_ < announced_end - frame_ns() / 2 ? Decoded::kCut : Decoded::kEnd;
}

/// False for a picture after a hole: with B pictures a file cut may hold one whose predecessors in time were to come later.
bool VideoFile::follows() {
  const TimeNs t = av::to_ns(frame_->best_effort_timestamp, stream().time_base);
  const bool hole = drained_ && decoder_->has_b_frames > 0 && t > shown_ns_ + frame_ns() * 3 / 2;
  shown_ns_ = t;
  return !hole;
}

/// Decodes the next whole picture into frame_.
VideoFile::Decoded VideoFile::decode() {
  while (true) {
    const int received = avcodec_receive_frame(decoder_.get(), frame_.get());
    if (received == AVERROR_EOF) return end_of_file();
    if (received >= 0 && !av::is_damaged(*frame_) && follows()) return Decoded::kFrame;
    if (received < 0) fail(received);
    if (received != AVERROR(EAGAIN)) return cut_ = true, Decoded::kCut;
    if (drained_) return Decoded::kCut;

    const int read = av_read_frame(container_.get(), packet_.get());
    const bool whole = read >= 0 && (packet_->flags & AV_PKT_FLAG_CORRUPT) == 0;
    if (whole && packet_->stream_index != stream_) {
      av_packet_unref(packet_.get());
      continue;
    }
    if (whole) {
      ++packets_;
      const std::int64_t start = packet_->pts != AV_NOPTS_VALUE ? packet_->pts : packet_->dts;
      const TimeNs duration = packet_->duration > 0 ? av::to_ns(packet_->duration, stream().time_base) : frame_ns();
      end_ns_ = std::max(end_ns_, av::to_ns(start, stream().time_base) + duration);
    }
    if (read < 0) fail(read);
    cut_ = !whole && read != AVERROR_EOF;
    drained_ = !whole;
    const int sent = avcodec_send_packet(decoder_.get(), whole ? packet_.get() : nullptr);
    av_packet_unref(sent_.get());
    av_packet_move_ref(sent_.get(), packet_.get());
    if (sent < 0) fail(sent);
    if (sent < 0 && sent != AVERROR_EOF) {
      // What the decoder holds back is whole: it is still given.
      cut_ = drained_ = true;
      avcodec_send_packet(decoder_.get(), nullptr);
    }
  }
}

Result<Next> VideoFile::next(Picture& into) {
  const Decoded decoded = pending_ ? Decoded::kFrame : decode();
  pending_ = false;
  if (failure_ != 0) return av::input_error("video " + name_, failure_, "");
  if (decoded == Decoded::kEnd) return Next::kEnd;
  if (decoded == Decoded::kCut) return Next::kCut;
  if (Size{frame_->width, frame_->height} != size_)
    return Error{ErrorCode::kUnsupported,
                 fmt::format("cannot read video {}: its pictures change size at number {}", name_, given_)};
  if (!to_rgb_.convert(*frame_, into.pixels))
    return Error{ErrorCode::kUnsupported,
                 fmt::format("cannot read video {}: its size or kind of pixels is not supported", name_)};
  into.t_ns = av::to_ns(frame_->best_effort_timestamp, stream().time_base);
  into.sequence = given_++;
  into.jpeg.clear();
  if (decoder_->codec_id == AV_CODEC_ID_MJPEG) into.jpeg.assign(sent_->data, sent_->data + sent_->size);
  if (const auto mark = CaptureMark::of(*sent_)) {
    into.t_ns = mark->t_ns;
    into.sequence = mark->sequence;
  }
  return Next::kNew;
}

}  // namespace

Result<std::unique_ptr<Source>> open_video(const std::filesystem::path& path, std::optional<int> track) {
  auto video = std::make_unique<VideoFile>();
  DUO_TRY(video->open(path, track));
  return std::unique_ptr<Source>(std::move(video));
}

}  // namespace duo
