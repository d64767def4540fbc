#include "sources/video.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "core/capture_mark.h"
#include "core/file.h"
#include "sources/container_end.h"
#include "sources/packet_check.h"
#include "sources/file_source.h"
#include "sources/libav.h"
#include "sources/orientation.h"
#include "sources/picture_bytes.h"
#include "sources/rising_times.h"
#include "sources/stereo_layout.h"

namespace duo {
namespace {

// Containers that hold nothing but their own bytes: play lists and the like could reach other files or the network.
constexpr char kContainers[] = "avi,matroska,webm,mov,mp4,mpegts,mpeg,mpjpeg,mjpeg";

Error unreadable(const std::filesystem::path& path, int error, const std::string& why) {
  return av::input_error("video " + path.string(), error, why);
}

class VideoFile final : public FileSource {
 public:
  Result<void> open(const std::filesystem::path& path, std::optional<int> track, const char* format);
  Size size() const override { return size_; }
  std::int64_t count() const override { return announced_; }
  bool still() const override { return false; }
  double frame_s() const override { return static_cast<double>(frame_ns()) * 1e-9; }
  std::string warning() const override;
  Result<Next> next(Picture& into) override;

  std::optional<ViewLayout> layout() const override { return layout_; }
  int views() const override;
  void scale_as(FileSource& other) override {
    if (auto* video = dynamic_cast<VideoFile*>(&other); video != nullptr) to_rgb_.scale_as(video->to_rgb_);
  }
  TimeNs first_ns() const override { return first_ns_; }
  TimeNs end_ns() const override;
  bool any_origin() const override { return std::strstr(container_->iformat->name, "mpeg") != nullptr; }
  void shift_times(TimeNs by_ns) override { shift_ns_ += by_ns; }
  std::int64_t number() const override { return number_; }
  std::vector<TimeNs> indexed_times() override;
  bool prepare_seek() override;
  Result<void> seek(std::int64_t number) override;

 private:
  enum class Decoded { kFrame, kEnd, kCut };
  Decoded decode();
  Decoded end_of_file() const;
  void feed();
  void leave_out();
  void fail(int error) {
    if (is_exhausted(AVUNERROR(error)) && error != AVERROR(EAGAIN)) failure_ = error;
  }
  bool follows();
  bool has_index() const { return std::strstr(container_->iformat->name, "mp4") != nullptr; }
  std::int64_t announced_packets() const;
  std::int64_t index_entries() const { return has_index() ? avformat_index_get_entries_count(&stream()) : 0; }
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
  Orientation orientation_ = Orientation::kTopLeft;
  Image<Rgb8> turned_;
  std::optional<ViewLayout> layout_;
  int stream_ = -1;
  bool alone_ = false;          // each picture is coded without others
  bool has_checksums_ = false;  // of FFV1, in each picture so far
  bool interlaced_ = false;     // as the container or the first picture says
  Size size_;
  std::int64_t announced_ = 0;  // packets; 0 = not announced
  std::int64_t packets_ = 0;    // read so far
  TimeNs first_ns_ = 0, shift_ns_ = 0;
  RisingTimes times_;             // of next()
  TimeNs shown_ns_ = 0;           // time of the last picture decoded
  TimeNs recorded_frame_ns_ = 0;  // of our own recordings: from picture to picture; 0: not one
  std::optional<bool> lacks_bytes_;
  std::uint64_t given_ = 0;
  std::int64_t number_ = 0;
  std::int64_t left_out_ = 0;                             // damaged pictures, and those that were coded by them
  int failure_ = 0;                                       // libav's, where it is not the file's fault
  bool drained_ = false;                                  // the decoder was told that nothing follows
  bool mending_ = false;                                  // so it was, and then it begins again
  bool to_key_ = false;                                   // packets are passed over up to one that begins anew
  bool last_damaged_ = false, last_lacks_bytes_ = false;  // of packets
  bool read_failed_ = false, at_end_ = false;
  bool pending_ = false;  // frame_ holds a picture that next() has not given yet
};

/// A track with a picture that is none of a video: a cover.
bool is_cover(const AVStream& s) { return (s.disposition & AV_DISPOSITION_ATTACHED_PIC) != 0; }

/// Number `track` of the video streams, or the best of them; below 0 when there is none.
int video_stream(AVFormatContext* container, std::optional<int> track) {
  if (!track) return av_find_best_stream(container, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  for (unsigned i = 0; i < container->nb_streams; ++i)
    if (container->streams[i]->codecpar->codec_type == AVMEDIA_TYPE_VIDEO && !is_cover(*container->streams[i]) &&
        (*track)-- == 0)
      return static_cast<int>(i);
  return -1;
}

Orientation orientation_of(const AVStream& stream) {
  std::array<std::int32_t, 9> matrix{};
  std::size_t bytes = 0;
  const std::uint8_t* data = av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, &bytes);
  if (data == nullptr || bytes != sizeof matrix) return Orientation::kTopLeft;
  std::memcpy(matrix.data(), data, sizeof matrix);
  return orientation_of_matrix(matrix);
}

Result<void> VideoFile::open(const std::filesystem::path& path, std::optional<int> track, const char* format) {
  name_ = path.string();
  if (!frame_ || !packet_ || !sent_) return unreadable(path, AVERROR(ENOMEM), "");
  av::Container opening(avformat_alloc_context());
  if (!opening || !av::allow_only(*opening, kContainers, "file")) return unreadable(path, AVERROR(ENOMEM), "");
  AVFormatContext* context = opening.release();
  AVDictionary* options = nullptr;
  if (format != nullptr) av_dict_set(&options, "framerate", "30", 0);  // of JPEGs one after the other, which have no times
  // Frees the context itself when it fails.
  const int e = avformat_open_input(&context, ("file:" + name_).c_str(), av_find_input_format(format), &options);
  av_dict_free(&options);
  if (e < 0)
    return unreadable(path, e, "it is no picture or video that can be read, or it was cut before its index was written");
  container_.reset(context);
  if (const int found = av::find_streams(*context); found < 0) return unreadable(path, found, av::reason(found));
  stream_ = video_stream(context, track);
  if (stream_ < 0) return unreadable(path, 0, "it holds no video");
  if (const std::string why = av::too_many_pixels({stream().codecpar->width, stream().codecpar->height}); !why.empty())
    return unreadable(path, 0, why);
  for (unsigned i = 0; i < context->nb_streams; ++i)
    context->streams[i]->discard = static_cast<int>(i) == stream_ ? AVDISCARD_DEFAULT : AVDISCARD_ALL;
  const AVCodecDescriptor* codec = avcodec_descriptor_get(stream().codecpar->codec_id);
  alone_ = codec != nullptr && (codec->props & AV_CODEC_PROP_INTRA_ONLY) != 0;
  decoder_ = av::open_decoder(stream().codecpar->codec_id, [this](AVCodecContext& decoder) {
    decoder.pkt_timebase = stream().time_base;
    // Where pictures do not need each other, a damaged one is no more than one that is missing.
    if (alone_) decoder.err_recognition = AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER | AV_EF_EXPLODE;
    return avcodec_parameters_to_context(&decoder, stream().codecpar) >= 0;
  });
  if (!decoder_)
    return Error{ErrorCode::kUnsupported,
                 fmt::format("cannot read video {}: no decoder for {}", name_, avcodec_get_name(stream().codecpar->codec_id))};
  recorded_frame_ns_ = CaptureMark::frame_ns(*context);
  announced_ = announced_packets();
  lacks_bytes_ = duo::lacks_bytes(path);
  if (decode() != Decoded::kFrame) return unreadable(path, failure_, "no whole picture at its start");
  pending_ = true;
  orientation_ = orientation_of(stream());
  size_ = upright({frame_->width, frame_->height}, orientation_);
  first_ns_ = av::to_ns(frame_->best_effort_timestamp, stream().time_base);
  to_rgb_.see(*frame_);
  interlaced_ = frame_->interlaced_frame != 0 || stream().codecpar->field_order > AV_FIELD_PROGRESSIVE;
  std::string other_layout;
  layout_ = layout_of(stream(), *frame_, other_layout);
  if (!other_layout.empty())
    return Error{ErrorCode::kUnsupported,
                 fmt::format("cannot read video {}: it holds its views as '{}', which is not read; convert it to side by side",
                             name_, other_layout)};
  return {};
}

int VideoFile::views() const {
  int same = 0;
  for (unsigned i = 0; i < container_->nb_streams; ++i) {
    const AVCodecParameters& other = *container_->streams[i]->codecpar;
    same += other.codec_type == AVMEDIA_TYPE_VIDEO && !is_cover(*container_->streams[i]) &&
            other.width == stream().codecpar->width && other.height == stream().codecpar->height;
  }
  return same;
}

TimeNs VideoFile::end_ns() const {
  const AVStream& s = stream();
  if (s.duration > 0) return first_ns_ + av::to_ns(s.duration, s.time_base);
  return container_->duration > 0 ? first_ns_ + av::to_ns(container_->duration, AV_TIME_BASE_Q) : 0;
}

std::string VideoFile::warning() const {
  std::string all;
  const bool last_is_cut = at_end_ && last_damaged_ && end_of_file() == Decoded::kCut;  // which is said elsewhere
  if (const std::int64_t damaged = left_out_ - (last_is_cut ? 1 : 0); damaged > 0)
    all = fmt::format("{} picture{} of {} {} damaged: left out", damaged, damaged == 1 ? "" : "s", name_,
                      damaged == 1 ? "is" : "are");
  const auto add = [&](const std::string& text) { all += (all.empty() || text.empty() ? "" : "; ") + text; };
  add(times_.warning(name_));
  if (interlaced_)
    add(fmt::format("{} is interlaced, rows of two moments; ffmpeg -i {} -vf bwdif -c:v ffv1 whole.mkv makes it whole", name_,
                    name_));
  return all;
}

/// What the container says of its length: that of AVI's header counts pictures that did not come, too.
std::int64_t VideoFile::announced_packets() const {
  // MP4: the index that the demuxer keeps leaves out what an edit list cuts away; nb_frames does not.
  const std::int64_t in_index = index_entries();
  return in_index > 0 ? in_index : std::max<std::int64_t>(stream().nb_frames, 0);
}

/// Only missing bytes are a cut: times and numbers of pictures say nothing, cameras give as many as there is light for.
VideoFile::Decoded VideoFile::end_of_file() const {
  // A recording says its length when it is finished.
  const bool unfinished = recorded_frame_ns_ > 0 && container_->duration <= 0;
  if (read_failed_ || last_lacks_bytes_ || unfinished) return Decoded::kCut;
  if (lacks_bytes_) return *lacks_bytes_ ? Decoded::kCut : Decoded::kEnd;
  if (has_index()) return packets_ < index_entries() ? Decoded::kCut : Decoded::kEnd;
  return last_damaged_ ? Decoded::kCut : Decoded::kEnd;  // it does not say where it ends
}

/// False for a picture after a hole: with B pictures a file cut may hold one whose predecessors in time were to come later.
bool VideoFile::follows() {
  const TimeNs t = av::to_ns(frame_->best_effort_timestamp, stream().time_base);
  const bool hole = drained_ && decoder_->has_b_frames > 0 && t > shown_ns_ + frame_ns() * 3 / 2 &&
                    (mending_ || end_of_file() == Decoded::kCut);
  if (!hole) shown_ns_ = t;
  return !hole;
}

std::vector<TimeNs> VideoFile::indexed_times() {
  const bool names_each = std::strcmp(container_->iformat->name, "avi") == 0 || has_index();
  // How bright a value of 16 bits comes depends on the pictures before.
  if (!alone_ || is_wide(decoder_->pix_fmt) || !names_each || lacks_bytes_.value_or(!has_index())) return {};
  AVStream* const s = container_->streams[stream_];
  const std::int64_t bytes = avio_size(container_->pb);
  std::vector<TimeNs> times;
  for (int i = 0; i < avformat_index_get_entries_count(s); ++i) {
    const AVIndexEntry& entry = *avformat_index_get_entry(s, i);
    const TimeNs t = av::to_ns(entry.timestamp, s->time_base) + shift_ns_;
    const bool rises = times.empty() || t > times.back();
    if ((entry.flags & AVINDEX_DISCARD_FRAME) != 0 || entry.size <= 0 || entry.pos + entry.size > bytes || !rises) return {};
    times.push_back(t);
  }
  return times;
}

bool VideoFile::prepare_seek() {
  if (recorded_frame_ns_ <= 0 || container_->duration <= 0 || is_wide(decoder_->pix_fmt)) return false;
  return av_seek_frame(container_.get(), stream_, 0, AVSEEK_FLAG_BACKWARD) >= 0;  // reads Matroska's index
}

Result<void> VideoFile::seek(std::int64_t number) {
  AVStream* const s = container_->streams[stream_];
  const AVIndexEntry* const entry = avformat_index_get_entry(s, static_cast<int>(number));
  const auto wrong = [&] {
    return Error{ErrorCode::kBadInput, fmt::format("cannot find picture {} of video {}: the file's index is wrong; write the "
                                                   "file anew, or take all of its frames",
                                                   number, name_)};
  };
  const AVIndexEntry* const before = avformat_index_get_entry(s, static_cast<int>(number - 1));
  if (entry == nullptr || (before != nullptr && before->timestamp >= entry->timestamp) ||
      av_seek_frame(container_.get(), stream_, entry->timestamp, AVSEEK_FLAG_ANY) < 0)
    return wrong();
  avcodec_flush_buffers(decoder_.get());
  packets_ = number;
  given_ = static_cast<std::uint64_t>(number);
  drained_ = mending_ = to_key_ = pending_ = false;
  times_.jump();
  if (decode() != Decoded::kFrame) return failure_ != 0 ? av::input_error("video " + name_, failure_, "") : wrong();
  pending_ = true;
  const AVIndexEntry* const found = avformat_index_get_entry(s, static_cast<int>(packets_ - 1));
  return found != nullptr && found->timestamp == frame_->best_effort_timestamp ? Result<void>() : wrong();
}

/// The picture that does not decode, and with it those that are coded by it.
void VideoFile::leave_out() {
  ++left_out_;
  last_damaged_ = true;
  if (drained_) return;
  to_key_ = true;
  if (alone_) return;
  // What the decoder holds back is whole: it is still given.
  mending_ = drained_ = true;
  avcodec_send_packet(decoder_.get(), nullptr);
}

/// Gives the decoder the next packet, or the end.
void VideoFile::feed() {
  const int read = av_read_frame(container_.get(), packet_.get());
  at_end_ = read < 0;
  if (at_end_) {
    fail(read);
    read_failed_ = read != AVERROR_EOF;
    drained_ = true;
    avcodec_send_packet(decoder_.get(), nullptr);
    return;
  }
  if (packet_->stream_index != stream_) return av_packet_unref(packet_.get());
  ++packets_;
  last_damaged_ = false;
  last_lacks_bytes_ = (packet_->flags & AV_PKT_FLAG_CORRUPT) != 0;
  const bool passed = to_key_ && (packet_->flags & AV_PKT_FLAG_KEY) == 0;
  const bool checks = decoder_->codec_id == AV_CODEC_ID_FFV1 && ffv1_checks(*packet_);
  has_checksums_ |= checks;
  if (passed || last_lacks_bytes_ || (has_checksums_ && !checks) || has_hole(*packet_, decoder_->codec_id)) {
    av_packet_unref(packet_.get());
    return passed ? static_cast<void>(++left_out_) : leave_out();
  }
  to_key_ = false;
  const int sent = avcodec_send_packet(decoder_.get(), packet_.get());
  av_packet_unref(sent_.get());
  av_packet_move_ref(sent_.get(), packet_.get());
  if (sent >= 0) return;
  fail(sent);
  leave_out();
}

/// Decodes the next whole picture into frame_.
VideoFile::Decoded VideoFile::decode() {
  while (failure_ == 0) {
    const int received = avcodec_receive_frame(decoder_.get(), frame_.get());
    if (received >= 0 && !av::is_damaged(*frame_)) {
      if (follows()) return Decoded::kFrame;
      if (!mending_) return Decoded::kCut;
      ++left_out_;
    } else if (received == AVERROR(EAGAIN)) {
      feed();
    } else if (received == AVERROR_EOF) {
      if (!std::exchange(mending_, false)) return end_of_file();
      drained_ = false;
      avcodec_flush_buffers(decoder_.get());
    } else {
      fail(received);
      leave_out();
    }
  }
  return Decoded::kCut;
}

Result<Next> VideoFile::next(Picture& into) {
  const Decoded decoded = pending_ ? Decoded::kFrame : decode();
  pending_ = false;
  if (failure_ != 0) return av::input_error("video " + name_, failure_, "");
  if (decoded == Decoded::kEnd) return Next::kEnd;
  if (decoded == Decoded::kCut) return Next::kCut;
  if (upright({frame_->width, frame_->height}, orientation_) != size_)
    return Error{ErrorCode::kUnsupported,
                 fmt::format("cannot read video {}: its pictures change size at number {}", name_, given_)};
  to_rgb_.see(*frame_);
  if (!to_rgb_.convert(*frame_, into.pixels))
    return Error{ErrorCode::kUnsupported,
                 fmt::format("cannot read video {}: its size or kind of pixels is not supported", name_)};
  put_upright(into.pixels, orientation_, turned_);
  into.t_ns = av::to_ns(frame_->best_effort_timestamp, stream().time_base);
  into.sequence = given_++;
  number_ = packets_ - 1;
  put_jpeg(decoder_->codec_id == AV_CODEC_ID_MJPEG ? av::bytes_of(*sent_) : std::string_view(), into);
  if (orientation_ != Orientation::kTopLeft) into.jpeg.clear();  // the pixels are turned
  if (const auto mark = CaptureMark::of(*sent_)) {
    into.t_ns = mark->t_ns;
    into.sequence = mark->sequence;
  }
  into.t_ns = times_.next(into.t_ns, frame_ns()) + shift_ns_;
  return Next::kNew;
}

}  // namespace

Result<std::unique_ptr<Source>> open_video(const std::filesystem::path& path, std::optional<int> track, const char* format) {
  auto video = std::make_unique<VideoFile>();
  DUO_TRY(video->open(path, track, format));
  return std::unique_ptr<Source>(std::move(video));
}

}  // namespace duo
