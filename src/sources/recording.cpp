#include "sources/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>
#include <vector>

#include "core/capture_mark.h"
#include "core/file.h"
#include "duoptic/recording.h"
#include "duoptic/source.h"
#include "sources/libav.h"

namespace duo {

std::string TwoTracks::tag(const char* name) const {
  const AVDictionaryEntry* entry = av_dict_get(container->metadata, name, nullptr, 0);
  return entry != nullptr ? entry->value : "";
}

Result<TwoTracks> open_two_tracks(const std::filesystem::path& path) {
  TwoTracks out;
  av::Container container(avformat_alloc_context());
  if (!container || !av::allow_only(*container, "matroska,webm", "file"))
    return av::input_error("recording " + path.string(), AVERROR(ENOMEM), "");
  AVFormatContext* context = container.release();
  // Frees the context itself when it fails.
  if (const int e = avformat_open_input(&context, ("file:" + path.string()).c_str(), nullptr, nullptr); e < 0) {
    if (is_exhausted(AVUNERROR(e))) return av::input_error("recording " + path.string(), e, "");
    return out;
  }
  container.reset(context);
  for (unsigned i = 0; i < context->nb_streams; ++i)
    if (context->streams[i]->codecpar->codec_type == AVMEDIA_TYPE_VIDEO &&
        (context->streams[i]->disposition & AV_DISPOSITION_ATTACHED_PIC) == 0)  // a cover
      out.views.push_back(context->streams[i]);
  if (out.views.size() == 2) out.container = std::move(container);
  return out;
}

Result<std::optional<Rig>> TwoTracks::rig(const std::string& name) const {
  for (unsigned i = 0; i < container->nb_streams; ++i) {
    const AVStream& s = *container->streams[i];
    const AVDictionaryEntry* file = av_dict_get(s.metadata, "filename", nullptr, 0);
    if (s.codecpar->codec_type != AVMEDIA_TYPE_ATTACHMENT || file == nullptr || std::strcmp(file->value, "rig.json") != 0)
      continue;
    const std::string_view json(reinterpret_cast<const char*>(s.codecpar->extradata),
                                static_cast<std::size_t>(s.codecpar->extradata_size));
    DUO_TRY_ASSIGN(Rig rig, parse_rig(json, name + ": rig.json"));
    return std::optional<Rig>(std::move(rig));
  }
  return std::optional<Rig>();
}

namespace {

/// True when a picture of a file of ours at `last_ns` is the last that the file had when it was finished: its length is up to
/// where that picture ends, and a free-running right camera is half a picture off.
bool is_last(const TwoTracks& tracks, TimeNs last_ns) {
  return (last_ns + tracks.frame_ns() / 4 * 7) / 1000 > tracks.container->duration;  // microseconds
}

/// Each picture has an entry in the index, which libav reads at the first search; none when it was cut off.
std::int64_t pairs_in_index(const TwoTracks& tracks) {
  if (!tracks.ours() || !tracks.finished()) return 0;
  AVStream* left = tracks.container->streams[tracks.views[0]->index];
  if (av_seek_frame(tracks.container.get(), left->index, 0, 0) < 0) return 0;
  const int entries = avformat_index_get_entries_count(left);
  const AVIndexEntry* last = entries > 0 ? avformat_index_get_entry(left, entries - 1) : nullptr;
  return last != nullptr && is_last(tracks, av::to_ns(last->timestamp, left->time_base)) ? entries : 0;
}

/// One track's pictures as they pass by.
struct Tally {
  RecordedView view;
  std::vector<TimeNs> t_ns;
  TimeNs last_ns = 0;                 // of the last block
  std::uint64_t first = 0, last = 0;  // numbers that the camera gave

  void add(const AVPacket& packet, AVRational base) {
    const auto mark = CaptureMark::of(packet);
    last_ns = av::to_ns(packet.pts, base);
    t_ns.push_back(av::capture_ns(packet, base));
    last = mark ? mark->sequence : static_cast<std::uint64_t>(view.pictures);
    if (view.pictures++ == 0) first = last;
  }
  void finish() {
    if (view.pictures == 0) return;
    const auto after_first = std::max<std::int64_t>(static_cast<std::int64_t>(last - first), 0);
    view.missing = std::max<std::int64_t>(after_first - view.pictures + 1, 0);
  }
};

void fill_times(const Tally& left, const Tally& right, RecordingReport& report) {
  const auto s = [](TimeNs ns) { return static_cast<double>(ns) * 1e-9; };
  const auto pairs = static_cast<std::size_t>(report.pairs);
  for (std::size_t i = 0; i < pairs; ++i) {
    report.skew_s = std::max(report.skew_s, s(std::abs(left.t_ns[i] - right.t_ns[i])));
    if (i > 0) report.longest_gap_s = std::max(report.longest_gap_s, s(left.t_ns[i] - left.t_ns[i - 1]));
  }
  if (pairs > 0) report.length_s = s(left.t_ns[pairs - 1] - left.t_ns[0]);
}

}  // namespace

Result<std::optional<RecordingHead>> read_recording_head(const std::filesystem::path& path) {
  DUO_TRY_ASSIGN(const TwoTracks tracks, open_two_tracks(path));
  if (!tracks.container) return std::optional<RecordingHead>();
  RecordingHead head{.ours = tracks.ours()};
  DUO_TRY_ASSIGN(head.rig, tracks.rig(path.string()));
  head.pairs = pairs_in_index(tracks);
  return std::optional<RecordingHead>(std::move(head));
}

Result<RecordingReport> inspect_recording(const std::filesystem::path& path) {
  if (const auto opened = open_source(path); !opened) return opened.error();  // says why it cannot be read at all
  DUO_TRY_ASSIGN(const TwoTracks tracks, open_two_tracks(path));
  if (!tracks.container)
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot play {}: it is no recording, a Matroska file with two video tracks", path.string())};
  RecordingReport report;
  DUO_TRY_ASSIGN(report.rig, tracks.rig(path.string()));
  report.size = {tracks.views[0]->codecpar->width, tracks.views[0]->codecpar->height};
  report.bytes = avio_size(tracks.container->pb);
  report.date = tracks.tag("creation_time");
  Tally tally[2];
  for (int i = 0; i < 2; ++i) tally[i].view.codec = avcodec_get_name(tracks.views[i]->codecpar->codec_id);
  const av::Packet packet(av_packet_alloc());
  int read = 0;
  for (; packet && (read = av_read_frame(tracks.container.get(), packet.get())) >= 0; av_packet_unref(packet.get()))
    for (int i = 0; i < 2; ++i)
      if (packet->stream_index == tracks.views[i]->index && (packet->flags & AV_PKT_FLAG_CORRUPT) == 0)
        tally[i].add(*packet, tracks.views[i]->time_base);
  if (!packet || (read < 0 && is_exhausted(AVUNERROR(read))))
    return av::input_error("recording " + path.string(), AVERROR(ENOMEM), "");
  for (Tally& t : tally) t.finish();
  report.left = tally[0].view;
  report.right = tally[1].view;
  report.pairs = std::min(report.left.pictures, report.right.pictures);
  fill_times(tally[0], tally[1], report);
  const bool whole = !tracks.ours() || (tracks.finished() && is_last(tracks, std::max(tally[0].last_ns, tally[1].last_ns)));
  report.cut = !whole || (read < 0 && read != AVERROR_EOF) || report.left.pictures != report.right.pictures;
  return report;
}

}  // namespace duo
