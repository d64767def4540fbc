#include <fmt/format.h>

#include "duoptic/reports.h"
#include "reports/report_json.h"

namespace duo {

std::string json_of(const DepthQuality& q, Window region, bool metric, const std::optional<RigFit>& fit) {
  nlohmann::json out = {{"frames", q.frames},
                        {"region", {region.x, region.y, region.width, region.height}},
                        {"metric", metric},
                        {"fill_rate_percent", q.fill_rate_percent},
                        {"distance_m", q.distance_m},
                        {"angle_deg", q.angle_deg},
                        {"plane_fit_rms_mm", q.plane_fit_rms_mm},
                        {"subpixel_rms_px", q.subpixel_rms_px},
                        {"temporal_noise_mm", nullptr},
                        {"temporal_noise_percent", nullptr},
                        {"z_error_mm", nullptr},
                        {"z_accuracy_percent", nullptr},
                        {"rig_fit", report_json(fit)}};
  if (q.frames > 1) out["temporal_noise_mm"] = q.temporal_noise_mm, out["temporal_noise_percent"] = q.temporal_noise_percent;
  if (q.z_error_mm) out["z_error_mm"] = *q.z_error_mm, out["z_accuracy_percent"] = *q.z_accuracy_percent;
  return json_text(out);
}

std::string text_of(const DepthQuality& q, Window region, bool metric) {
  const char *m = metric ? "m" : "units", *mm = metric ? "mm" : "thousandths";
  std::string text = fmt::format("region          {}x{} px at {},{}, {} frame{}\n", region.width, region.height, region.x,
                                 region.y, q.frames, q.frames == 1 ? "" : "s");
  text += fmt::format("wall            {:.3f} {} away, turned by {:.1f} degrees\n", q.distance_m, m, q.angle_deg);
  text += fmt::format("fill rate       {:.1f} %\n", q.fill_rate_percent);
  text += fmt::format("plane-fit RMS   {:.2f} {}\n", q.plane_fit_rms_mm, mm);
  text += fmt::format("sub-pixel RMS   {:.3f} px\n", q.subpixel_rms_px);
  if (q.frames > 1)
    text += fmt::format("temporal noise  {:.2f} {} = {:.3f} %\n", q.temporal_noise_mm, mm, q.temporal_noise_percent);
  if (q.z_error_mm) text += fmt::format("z error         {:+.1f} {} = {:+.2f} %\n", *q.z_error_mm, mm, *q.z_accuracy_percent);
  return text;
}

}  // namespace duo
