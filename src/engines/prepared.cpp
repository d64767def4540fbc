#include "engines/prepared.h"

#include "calib/rig_size.h"
#include "calib/row_offsets.h"

#include <fmt/format.h>

#include <algorithm>

namespace duo {
namespace {

// What raw webcam pictures get when nothing is asked for; docs/measurements.md has the comparison.
constexpr Denoise kRawDenoise = Denoise::kGaussian;

Error bad(std::string what) { return {ErrorCode::kBadInput, std::move(what)}; }

bool denoises(const Prepared& prepared) { return prepared.median || prepared.gaussian || prepared.diffusion; }

}  // namespace

Result<Prepared> prepare_setup(const Setup& setup) {
  Prepared out;
  out.setup = setup;
  if (setup.size.empty()) return bad("prepare the engine: the pictures have no pixels; give pictures of at least 1x1");
  if (setup.max_disparity < 1 || setup.max_disparity > Engine::kMaxDisparity)
    return bad(
        fmt::format("prepare the engine: max disparity {} is not in 1 .. {}; choose the disparity of the nearest thing in px",
                    setup.max_disparity, Engine::kMaxDisparity));
  if (setup.rows && setup.rig)
    return bad("prepare the engine: a rig and row offsets were given; a rig says where the rows are, so give one of them");
  if (setup.rows && setup.rows->size != setup.size)
    return bad(fmt::format("prepare the engine: the row offsets are of {}x{}, the pictures are {}x{}; find them again",
                           setup.rows->size.width, setup.rows->size.height, setup.size.width, setup.size.height));
  if (setup.wants.depth && !setup.rig)
    return bad(
        "prepare the engine: depth in metres needs a rig (focal length and baseline); give one, or take disparity alone");
  DUO_TRY_ASSIGN(out.matcher, Matchers::choose(setup));

  const Denoise denoise = setup.denoise != Denoise::kAuto ? setup.denoise : (setup.rig ? kRawDenoise : Denoise::kNone);
  out.median = denoise == Denoise::kMedian || denoise == Denoise::kBoth;
  out.gaussian = denoise == Denoise::kGaussian || denoise == Denoise::kBoth;
  out.diffusion = denoise == Denoise::kDiffusion;
  out.color = setup.wants.color || setup.wants.on_device;
  out.match_color = Matchers::takes_color(out.matcher);
  out.match_fill = setup.fill && Matchers::fills(out.matcher);

  out.size = setup.size;
  if (setup.rig) {
    const Rig& rig = *setup.rig;
    if (const std::string why = why_other_size(rig, setup.size); !why.empty()) return bad("cannot use the rig: " + why);
    DUO_TRY_ASSIGN(out.rectification, make_rectification(rig, "rig"));
    out.geometry = out.rectification->geometry;
    out.size = out.geometry->size;
  } else if (setup.rows) {
    out.rectification = row_maps(*setup.rows);
  }
  return out;
}

MatchSetup match_setup(const Prepared& prepared) {
  return {prepared.size,   prepared.setup.max_disparity, prepared.rectification.has_value(),
          prepared.stream, prepared.setup.progress,      denoises(prepared)};
}

int coding_noise_q4(const Prepared& prepared, const Pair& pair) {
  if (denoises(prepared)) return 0;
  return std::max(pair.left.coding_noise_q4, pair.right.coding_noise_q4);
}

float focal_baseline_px_mm(const Rectified& geometry) {
  return static_cast<float>(geometry.focal_px * geometry.baseline_m * 1000.0);
}

Frame make_frame(const Prepared& prepared) {
  Frame frame;
  frame.left = Image<std::uint8_t>(prepared.size);
  frame.right = Image<std::uint8_t>(prepared.size);
  if (prepared.rectification) {
    frame.left_inside = Image<std::uint8_t>(prepared.size);
    frame.right_inside = Image<std::uint8_t>(prepared.size);
  }
  if (prepared.color) frame.color = Image<Rgb8>(prepared.size);
  if (prepared.setup.wants.confidence) frame.confidence = Image<std::uint8_t>(prepared.size);
  if (prepared.setup.wants.depth) frame.depth_mm = Image<std::uint16_t>(prepared.size);
  frame.disparity.d_q4 = Image<std::uint16_t>(prepared.size);
  frame.disparity.origin = Image<std::uint8_t>(prepared.size);
  return frame;
}

}  // namespace duo
