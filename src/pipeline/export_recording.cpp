// A recording's tracks as files of their own.
#include <fmt/format.h>

#include <array>
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "core/file.h"
#include "core/libav_file.h"
#include "duoptic/recording.h"
#include "sources/recording.h"

namespace duo {
namespace {

/// Packets of one track into an AVI, one after the other at a fixed rate.
class PacketAvi {
 public:
  Result<void> open(const std::filesystem::path& path, const AVStream& from) {
    DUO_TRY_ASSIGN(PartialFile file, PartialFile::open(path));
    file_.emplace(std::move(file));
    path_ = path;
    AVFormatContext* made = nullptr;
    if (const int e = avformat_alloc_output_context2(&made, nullptr, "avi", nullptr); e < 0) return failed(e);
    muxer_.reset(made);
    muxer_->flags |= AVFMT_FLAG_BITEXACT;  // no date inside
    AVStream* to = avformat_new_stream(made, nullptr);
    if (to == nullptr || avcodec_parameters_copy(to->codecpar, from.codecpar) < 0) return failed(AVERROR(ENOMEM));
    to->codecpar->codec_tag = 0;
    rate_ = from.avg_frame_rate.num > 0 ? from.avg_frame_rate : AVRational{30, 1};
    to->time_base = av_inv_q(rate_);
    to->avg_frame_rate = to->r_frame_rate = rate_;
    if (const int e = av::write_into(*made, file_->fd()); e < 0) return failed(e);
    if (const int e = avformat_write_header(made, nullptr); e < 0) return failed(e);
    return {};
  }
  Result<void> write(AVPacket& packet) {
    packet.stream_index = 0;
    packet.pts = packet.dts = count_++;
    packet.duration = 1;
    av_packet_rescale_ts(&packet, av_inv_q(rate_), muxer_->streams[0]->time_base);
    if (const int e = av_write_frame(muxer_.get(), &packet); e < 0) return failed(e);
    return muxer_->pb->error < 0 ? Result<void>(failed(muxer_->pb->error)) : Result<void>();
  }
  Result<void> finish() {
    if (const int e = av_write_trailer(muxer_.get()); e < 0) return failed(e);
    if (const int e = av::flush(*muxer_); e < 0) return failed(e);
    return file_->publish();
  }

 private:
  Error failed(int error) const { return write_error(path_, AVUNERROR(error)); }

  std::optional<PartialFile> file_;
  std::filesystem::path path_;
  av::Muxer muxer_;
  AVRational rate_ = {};
  std::int64_t count_ = 0;
};

/// `t_ns`: when left and right were taken.
std::string times_row(std::int64_t pair, const AVPacket& left, const AVPacket& right, const std::array<TimeNs, 2>& t_ns) {
  const auto number = [&](const AVPacket& packet) {
    const auto mark = CaptureMark::of(packet);
    return mark ? mark->sequence : static_cast<std::uint64_t>(pair);
  };
  return fmt::format("{},{:.9f},{:.9f},{},{}\n", pair, static_cast<double>(t_ns[0]) * 1e-9, static_cast<double>(t_ns[1]) * 1e-9,
                     number(left), number(right));
}

}  // namespace

Result<void> export_recording(const std::filesystem::path& path, const RecordingFiles& to) {
  DUO_TRY_ASSIGN(const TwoTracks tracks, open_two_tracks(path));
  if (!tracks.container)
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot export {}: it is no Matroska file with two video tracks", path.string())};
  std::array<PacketAvi, 2> avis;
  DUO_TRY(avis[0].open(to.left_avi, *tracks.views[0]));
  DUO_TRY(avis[1].open(to.right_avi, *tracks.views[1]));
  std::string times = "pair,left_t_s,right_t_s,left_number,right_number\n";
  std::array<std::deque<av::Packet>, 2> waiting;  // for the other picture of their pair
  std::int64_t pairs = 0;
  while (true) {
    av::Packet packet(av::had_memory(av_packet_alloc()));
    if (av::had_memory(av_read_frame(tracks.container.get(), packet.get())) < 0) break;
    for (std::size_t i = 0; packet && i < 2; ++i)
      if (packet->stream_index == tracks.views[i]->index) waiting[i].push_back(std::move(packet));
    if (waiting[0].empty() || waiting[1].empty()) continue;
    const AVPacket &left = *waiting[0].front(), &right = *waiting[1].front();
    times += times_row(pairs++, left, right,
                       {av::capture_ns(left, tracks.views[0]->time_base), av::capture_ns(right, tracks.views[1]->time_base)});
    for (std::size_t i = 0; i < 2; ++i) {
      DUO_TRY(avis[i].write(*waiting[i].front()));
      waiting[i].pop_front();
    }
  }
  DUO_TRY(avis[0].finish());
  DUO_TRY(avis[1].finish());
  return write_file(to.times_csv, times);
}

}  // namespace duo
