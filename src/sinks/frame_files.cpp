#include "duoptic/frame_files.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/file.h"
#include "core/json_text.h"
#include "duoptic/paint.h"

namespace duo {
namespace {

constexpr const char* kDisparityFile = "disparity.pfm";
constexpr const char* kDisparityPicture = "disparity.png";
constexpr const char* kDepthFile = "depth.png";
constexpr const char* kCloudFile = "cloud.ply";
constexpr const char* kPictureFile = "left_rectified.png";
constexpr const char* kCameraFile = "camera.json";
constexpr const char* kConfidenceFile = "confidence.png";

}  // namespace

bool FrameFiles::has(FrameOutput output) const { return std::find(outputs.begin(), outputs.end(), output) != outputs.end(); }

std::vector<std::string> frame_file_names() {
  return {kDisparityFile, kDisparityPicture, kDepthFile, kCloudFile, kPictureFile, kCameraFile, kConfidenceFile};
}

Image<std::uint16_t> near_depth(const Image<std::uint16_t>& depth_mm, double far_m) {
  const double far_mm = 1000 * far_m;
  Image<std::uint16_t> out = depth_mm.clone();
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      if (out.at(y, x) > far_mm) out.at(y, x) = 0;
  return out;
}

Result<void> write_frame(const Frame& frame, const std::optional<Rectified>& rectified, const FrameFiles& files,
                         const std::function<std::filesystem::path(const std::string& name)>& place) {
  const View<const std::uint16_t> d_q4 = frame.disparity.d_q4;
  if (files.has(FrameOutput::kDisparity)) {
    DUO_TRY(write_pfm(d_q4, place(kDisparityFile)));
    DUO_TRY(write_png(draw_disparity(d_q4, rectified && files.cloud.metric ? &*rectified : nullptr), place(kDisparityPicture)));
  }
  if (files.has(FrameOutput::kConfidence) && !frame.confidence.empty())
    DUO_TRY(write_png(frame.confidence, place(kConfidenceFile)));
  if (!rectified) return {};
  if (files.has(FrameOutput::kDepth)) DUO_TRY(write_png(near_depth(frame.depth_mm, files.cloud.far_m), place(kDepthFile)));
  if (files.has(FrameOutput::kPicture)) DUO_TRY(write_png(frame.color, place(kPictureFile)));
  if (files.has(FrameOutput::kCamera))
    DUO_TRY(write_file(place(kCameraFile), camera_json(*rectified, files.cloud.metric, files.disparity_sigma_px)));
  if (!files.has(FrameOutput::kCloud)) return {};
  return write_ply(d_q4, frame.color, *rectified, place(kCloudFile), files.cloud);
}

std::string camera_json(const Rectified& r, bool metric, double disparity_sigma_px) {
  const double f = r.focal_px, cx = r.cx_px, cy = r.cy_px;
  const nlohmann::ordered_json out = {{"schema", "duoptic.camera"},
                                      {"version", 1},
                                      {"width", r.size.width},
                                      {"height", r.size.height},
                                      {"K", {f, 0, cx, 0, f, cy, 0, 0, 1}},
                                      {"baseline_m", r.baseline_m},
                                      {"Q", {1, 0, 0, -cx, 0, 1, 0, -cy, 0, 0, 0, f, 0, 0, 1 / r.baseline_m, 0}},
                                      {"rectified_from_left", r.rig_from_left.m},
                                      {"depth_unit_m", metric ? nlohmann::ordered_json(0.001) : nlohmann::ordered_json()},
                                      {"depth_none", 0},
                                      {"metric", metric},
                                      {"disparity_sigma_px", disparity_sigma_px},
                                      {"picture", kPictureFile},
                                      {"depth", kDepthFile},
                                      {"disparity", kDisparityFile}};
  return json_text(out) + "\n";
}

}  // namespace duo
