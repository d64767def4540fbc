// Recorder: pairs into Matroska, through libav.
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <utility>

#include "core/capture_mark.h"
#include "core/file.h"
#include "duoptic/stdout.h"
#include "core/libav_file.h"
#include "duoptic/recording.h"
#include "sinks/coded_view.h"
#include "sinks/file_room.h"

namespace duo {
namespace {

constexpr AVRational kNs = {1, 1'000'000'000}, kMs = {1, 1000};

}  // namespace

struct Recorder::State {
  State(std::filesystem::path to, const RecorderSetup& with, PartialFile into)
      : path(std::move(to)), setup(with), file(std::move(into)), room(file.fd()) {}
  ~State() {
    try {
      static_cast<void>(end());
    } catch (const std::bad_alloc&) {  // the index is missing then, and no pair
    }
  }

  Result<void> begin(const Pair& first);
  Result<void> add_view(const Picture& first, const char* title);
  Result<void> attach_rig();
  Result<void> append(const Pair& pair);
  Result<void> mux(AVPacket& packet, const Picture& picture, int track);
  Result<void> end();
  Error failed(int error) const { return write_error(path, AVUNERROR(error)); }

  std::filesystem::path path;
  RecorderSetup setup;
  PartialFile file;
  FileRoom room;
  av::Muxer muxer;
  std::vector<CodedView> views;
  TimeNs start_ns = 0;
  std::array<std::int64_t, 2> last_ms = {};
  std::int64_t pairs = 0, bytes = 0;
  bool open = true;
};

Result<void> Recorder::State::add_view(const Picture& first, const char* title) {
  DUO_TRY_ASSIGN(CodedView view, CodedView::open(first));
  AVStream* stream = avformat_new_stream(muxer.get(), nullptr);
  if (stream == nullptr || !view.describe(*stream->codecpar)) return failed(AVERROR(ENOMEM));
  constexpr int kFinest = 60000;  // holds 30000/1001 and makes 30/1 of a time rounded to nanoseconds
  stream->avg_frame_rate = av_d2q(1 / setup.frame_s, kFinest);
  stream->time_base = kMs;
  av_dict_set(&stream->metadata, "title", title, 0);
  if (views.empty()) stream->disposition = AV_DISPOSITION_DEFAULT;  // the one that players show first
  views.push_back(std::move(view));
  return {};
}

Result<void> Recorder::State::attach_rig() {
  const std::string json = json_from_rig(*setup.rig);
  AVStream* stream = avformat_new_stream(muxer.get(), nullptr);
  if (stream == nullptr) return failed(AVERROR(ENOMEM));
  AVCodecParameters& p = *stream->codecpar;
  p.codec_type = AVMEDIA_TYPE_ATTACHMENT;
  p.extradata = static_cast<std::uint8_t*>(av_mallocz(json.size() + AV_INPUT_BUFFER_PADDING_SIZE));
  if (p.extradata == nullptr) return failed(AVERROR(ENOMEM));
  p.extradata_size = static_cast<int>(json.size());
  json.copy(reinterpret_cast<char*>(p.extradata), json.size());
  av_dict_set(&stream->metadata, "filename", "rig.json", 0);
  av_dict_set(&stream->metadata, "mimetype", "application/json", 0);
  return {};
}

/// The head: tracks, tags and rig come before the first picture, where no cut takes them.
Result<void> Recorder::State::begin(const Pair& first) {
  constexpr std::int64_t kHead = 1 << 16;
  if (const int error = room.reserve(kHead); error != 0) return write_error(path, error);
  AVFormatContext* made = nullptr;
  if (const int e = avformat_alloc_output_context2(&made, nullptr, "matroska", nullptr); e < 0) return failed(e);
  muxer.reset(made);
  muxer->flags |= AVFMT_FLAG_BITEXACT | AVFMT_FLAG_FLUSH_PACKETS;
  views.reserve(2);
  DUO_TRY(add_view(first.left, "left"));
  DUO_TRY(add_view(first.right, "right"));
  if (setup.rig) DUO_TRY(attach_rig());
  av_dict_set_int(&muxer->metadata, CaptureMark::kFrameTag, std::llround(setup.frame_s * 1e9), 0);
  if (!setup.date.empty()) av_dict_set(&muxer->metadata, "creation_time", setup.date.c_str(), 0);
  if (const int e = av::write_into(*muxer, file.fd()); e < 0) return failed(e);
  if (const int e = avformat_write_header(muxer.get(), nullptr); e < 0) return failed(e);
  start_ns = std::min(first.left.t_ns, first.right.t_ns);
  return {};
}

Result<void> Recorder::State::mux(AVPacket& packet, const Picture& picture, int track) {
  const CaptureMark mark{picture.t_ns - start_ns, picture.sequence};
  if (!mark.put(packet)) return failed(AVERROR(ENOMEM));
  std::int64_t& last = last_ms[static_cast<std::size_t>(track)];
  // Players want times that never go back; the mark holds what was measured.
  last = std::max(last, av_rescale_q(mark.t_ns, kNs, kMs));
  packet.stream_index = track;
  packet.flags |= AV_PKT_FLAG_KEY;
  packet.pts = packet.dts = last;
  packet.duration = std::llround(setup.frame_s * 1e3);
  av_packet_rescale_ts(&packet, kMs, muxer->streams[track]->time_base);
  if (const int e = av_write_frame(muxer.get(), &packet); e < 0) return failed(e);
  return {};
}

Result<void> Recorder::State::append(const Pair& pair) {
  // What Matroska puts around two pictures, an entry of the index, and the end of a file without its index.
  constexpr std::int64_t kAround = 512, kEntry = 48, kEnd = 4096;
  if (!open) return Error{ErrorCode::kWriteFailed, fmt::format("cannot record into '{}': it is finished", path.string())};
  if (pairs == 0) DUO_TRY(begin(pair));
  const av::Packet left = views[0].code(pair.left), right = views[1].code(pair.right);
  if (!left || !right)
    return Error{ErrorCode::kUnsupported,
                 fmt::format("cannot record pair {} into '{}': a picture is not like the first ones; start a new recording",
                             pairs, path.string())};
  const std::int64_t end = avio_tell(muxer->pb) + left->size + right->size + kAround + 2 * kEntry * (pairs + 1) + kEnd;
  if (const int error = room.reserve(end); error != 0) return write_error(path, error);
  DUO_TRY(mux(*left, pair.left, 0));
  DUO_TRY(mux(*right, pair.right, 1));
  // Ends the cluster: libav holds it back until then.
  if (const int e = av_write_frame(muxer.get(), nullptr); e < 0) return failed(e);
  if (muxer->pb->error < 0) return failed(muxer->pb->error);
  if (pairs == 0) DUO_TRY(file.take_name(setup.replace ? PartialFile::Earlier::kReplace : PartialFile::Earlier::kKeep));
  ++pairs;
  bytes = avio_tell(muxer->pb);
  return {};
}

Result<void> Recorder::State::end() {
  if (!std::exchange(open, false) || pairs == 0) return {};
  const int completed = av_write_trailer(muxer.get()), flushed = av::flush(*muxer), trimmed = room.give_back();
  bytes = avio_size(muxer->pb);
  DUO_TRY(file.publish());
  if (completed < 0 || flushed < 0) return failed(std::min(completed, flushed));
  if (trimmed != 0) return write_error(path, trimmed);
  return {};
}

Recorder::Recorder(std::unique_ptr<State> state) : state_(std::move(state)) {}
Recorder::Recorder(Recorder&&) noexcept = default;
Recorder& Recorder::operator=(Recorder&&) noexcept = default;
Recorder::~Recorder() = default;

Result<Recorder> Recorder::open(const std::filesystem::path& path, const RecorderSetup& setup) {
  av_log_set_level(AV_LOG_QUIET);  // what is wrong is said in our results
  if (is_stdout(path))
    return Error{ErrorCode::kWriteFailed,
                 "cannot record to stdout: a recording is completed in places already written; name a file"};
  DUO_TRY_ASSIGN(PartialFile file, PartialFile::open(path));
  struct stat there {};
  if (!setup.replace && ::lstat(path.c_str(), &there) == 0)
    return Error{ErrorCode::kWriteFailed,
                 fmt::format("cannot record into '{}': a file of that name is there, and what it holds "
                             "may not be had again; choose another name or replace it by --force",
                             path.string())};
  return Recorder(std::make_unique<State>(path, setup, std::move(file)));
}

Result<void> Recorder::write(const Pair& pair) {
  const Result<void> appended = state_->append(pair);
  if (appended) return {};
  static_cast<void>(state_->end());
  Error error = appended.error();
  if (state_->pairs > 0)
    error.what += fmt::format("; what was recorded, {} pair{}, is in it", state_->pairs, state_->pairs == 1 ? "" : "s");
  return error;
}

Result<void> Recorder::finish() { return state_->end(); }

std::int64_t Recorder::pairs() const { return state_->pairs; }
std::int64_t Recorder::bytes() const { return state_->bytes; }
std::string Recorder::codecs() const {
  return state_->views.size() < 2 ? "" : state_->views[0].codec() + ", " + state_->views[1].codec();
}

}  // namespace duo
