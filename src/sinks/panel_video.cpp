#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "duoptic/paint.h"
#include "duoptic/sink.h"
#include "sinks/video_writer.h"

namespace duo {
namespace {

class PanelVideo final : public Sink {
 public:
  PanelVideo(VideoWriter video, TrackHeader header) : video_(std::move(video)), header_(std::move(header)) {}

  Result<void> write(const TrackedFrame& frame) override {
    if (range_.empty()) {
      constexpr double kNearer = 1.7;  // fixed from the first frame on, so that a colour is a depth
      range_ = roomy_range(frame.frame->disparity.d_q4, kNearer);
    }
    return video_.write(draw_panels(frame, header_, range_));
  }
  bool wants_pictures() const override { return true; }
  Result<void> finish() override { return video_.finish(); }

 private:
  VideoWriter video_;
  TrackHeader header_;
  DisparityRange range_;
};

}  // namespace

Result<std::unique_ptr<Sink>> make_panel_video(const std::filesystem::path& path, const TrackHeader& header,
                                               std::string& note) {
  DUO_TRY_ASSIGN(VideoWriter video, VideoWriter::open(path, panels_size(header), header.frame_s));
  if (!video.is_h264())
    note = fmt::format("libav has no H.264 encoder here (libx264); {} is MPEG-4 part 2", shown(path).string());
  return std::unique_ptr<Sink>(std::make_unique<PanelVideo>(std::move(video), header));
}

}  // namespace duo
