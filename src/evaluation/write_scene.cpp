#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/file.h"
#include "core/json_text.h"
#include "duoptic/output_set.h"
#include "duoptic/paint.h"
#include "duoptic/sink.h"
#include "duoptic/structured_light.h"

namespace duo {

Result<void> write_scene(const LightTruth& truth, const std::filesystem::path& folder) {
  constexpr int kScale = 32, kStep = 16;  // matchers search a multiple of 16
  const Size size = truth.disparity_px.size();
  Image<std::uint16_t> scaled(size), d_q4(size);
  float most = 0;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const float d = truth.disparity_px.at(y, x);
      most = std::max(most, d);
      // What is known is not 0, which means unknown.
      scaled.at(y, x) = d > 0 ? static_cast<std::uint16_t>(std::max(1L, std::lround(d * kScale))) : 0;
      d_q4.at(y, x) = d > 0 ? static_cast<std::uint16_t>(std::lround(d * 16)) : Disparity::kNone;
    }
  const int search = (static_cast<int>(most) / kStep + 1) * kStep;
  const nlohmann::ordered_json meta = {{"gt_scale", kScale}, {"ndisp", search}, {"eval_border", 0}};
  DUO_TRY_ASSIGN(OutputSet out, OutputSet::open(folder));
  DUO_TRY(write_png(truth.pair.left.pixels, out / "left.png"));
  DUO_TRY(write_png(truth.pair.right.pixels, out / "right.png"));
  DUO_TRY(write_png(scaled, out / "disp_left.png"));
  DUO_TRY(write_png(draw_disparity(d_q4, truth.rectified ? &*truth.rectified : nullptr), out / "disparity.png"));
  DUO_TRY(write_file(out / "meta.json", json_text(meta) + "\n"));
  // Masks of another scene would not fit this one.
  return out.publish({"mask_nonocc.png", "mask_disc.png"});
}

}  // namespace duo
