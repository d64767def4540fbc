#include "frame_files.h"

#include "duoptic/paint.h"
#include "duoptic/sink.h"

namespace duo::app {

Result<void> write_frame(const Frame& frame, const std::optional<Rectified>& rectified, OutputSet& out) {
  const View<const std::uint16_t> d_q4 = frame.disparity.d_q4;
  DUO_TRY(write_pfm(d_q4, out / "disparity.pfm"));
  DUO_TRY(write_png(draw_disparity(d_q4, rectified ? &*rectified : nullptr), out / "disparity.png"));
  if (!frame.confidence.empty()) DUO_TRY(write_png(frame.confidence, out / "confidence.png"));
  if (!rectified) return {};
  DUO_TRY(write_png(frame.depth_mm, out / "depth.png"));
  return write_ply(d_q4, frame.color, *rectified, out / "cloud.ply");
}

double coverage(const Frame& frame) {
  const Image<std::uint8_t>& origin = frame.disparity.origin;
  std::int64_t known = 0;
  for (int y = 0; y < origin.height(); ++y)
    for (int x = 0; x < origin.width(); ++x) known += origin.at(y, x) != static_cast<std::uint8_t>(Origin::kNone);
  return static_cast<double>(known) / (static_cast<double>(origin.width()) * origin.height());
}

}  // namespace duo::app
