#include "duoptic/evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "duoptic/engine.h"
#include "duoptic/source.h"
#include "evaluation/json_file.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
constexpr float kGapPx = 2.0f;   // disparities further apart belong to different surfaces
constexpr float kSamePx = 1.0f;  // nearer to each other: the same surface
constexpr int kWindowPx = 9;

Result<Picture> load_picture(const fs::path& path, Size expected) {
  DUO_TRY_ASSIGN(const auto source, open_source(path));
  if (!expected.empty() && source->size() != expected)
    return Error{ErrorCode::kBadInput, fmt::format("cannot use {}: its size differs from left.png", path.string())};
  Picture picture;
  DUO_TRY_ASSIGN([[maybe_unused]] const Next next, source->next(picture));
  return picture;
}

/// A gray PNG with all its bits, 8 or 16; of other pictures the red channel.
Result<Image<float>> load_truth(const fs::path& path, Size size, double scale) {
  DUO_TRY_ASSIGN(const Picture picture, load_picture(path, size));
  const auto gray = read_png16(path);
  Image<float> out(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      out.at(y, x) = static_cast<float>((gray ? gray->at(y, x) : picture.pixels.at(y, x).r) / scale);
  return out;
}

/// 255 where the mask has `value` and the pixel counts at all.
Result<Image<std::uint8_t>> load_mask(const fs::path& path, const Image<std::uint8_t>& all, std::uint8_t value) {
  DUO_TRY_ASSIGN(const Picture picture, load_picture(path, all.size()));
  Image<std::uint8_t> out(all.size());
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) out.at(y, x) = picture.pixels.at(y, x).r == value ? all.at(y, x) : 0;
  return out;
}

/// The truth carried to the right view, nearest surface first; -1 where nothing lands.
Image<float> carry_to_right(const Image<float>& truth_px) {
  Image<float> out(truth_px.size());
  for (int y = 0; y < out.height(); ++y) {
    std::fill_n(out.row(y), out.width(), -1.0f);
    for (int x = 0; x < out.width(); ++x) {
      const float d = truth_px.at(y, x);
      const int to = static_cast<int>(std::lround(static_cast<float>(x) - d));
      if (d > 0 && to >= 0) out.at(y, to) = std::max(out.at(y, to), d);
    }
  }
  return out;
}

/// Whether the point that lands at x_right on row y is still in front there.
bool is_seen(const Image<float>& carried, int y, float x_right, float d) {
  const auto in_front = [&](float column) {
    const int x = static_cast<int>(column);
    return x >= 0 && x < carried.width() && std::abs(carried.at(y, x) - d) <= kSamePx;
  };
  return x_right > -0.5f && (in_front(std::floor(x_right)) || in_front(std::ceil(x_right)));
}

struct Meta {
  double scale = 0;
  int max_disparity = 0, border_px = 0;
};

Result<Meta> load_meta(const fs::path& path) {
  DUO_TRY_ASSIGN(const nlohmann::json json, read_json(path));
  const auto number = [&](const char* key, double otherwise) {
    const auto at = json.find(key);
    return at == json.end() ? otherwise : at->is_number() ? at->get<double>() : -1;
  };
  if (json.is_object()) {
    constexpr double kMostBorder_px = 1 << 20;
    const double scale = number("gt_scale", 0), most = number("ndisp", 0), border = number("eval_border", 0);
    if (scale > 0 && most >= 1 && most <= Engine::kMaxDisparity && border >= 0 && border <= kMostBorder_px)
      return Meta{scale, static_cast<int>(most), static_cast<int>(border)};
  }
  return Error{
      ErrorCode::kBadInput,
      fmt::format("cannot use {}: it must be JSON with numbers gt_scale > 0 and ndisp 1 .. {}, perhaps eval_border >= 0",
                  path.string(), Engine::kMaxDisparity)};
}

}  // namespace

SceneRegions regions_of_truth(const Image<float>& truth_px, int border_px) {
  const int w = truth_px.width(), h = truth_px.height();
  SceneRegions out{Image<std::uint8_t>({w, h}), Image<std::uint8_t>({w, h}), Image<std::uint8_t>({w, h})};
  const Image<float> carried = carry_to_right(truth_px);
  Image<std::uint8_t> edge({w, h});
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const float d = truth_px.at(y, x);
      const bool known = d > 0, inside = x >= border_px && y >= border_px && x < w - border_px && y < h - border_px;
      out.all.at(y, x) = inside && known ? 255 : 0;
      const bool seen = known && is_seen(carried, y, static_cast<float>(x) - d, d);
      out.nonocc.at(y, x) = seen ? out.all.at(y, x) : 0;
      if (inside && !seen) edge.at(y, x) = 255;
      const auto jumps = [&](int y2, int x2) {
        return known && truth_px.at(y2, x2) > 0 && std::abs(truth_px.at(y2, x2) - d) >= kGapPx;
      };
      if (x + 1 < w && jumps(y, x + 1)) edge.at(y, x) = edge.at(y, x + 1) = 255;
      if (y + 1 < h && jumps(y + 1, x)) edge.at(y, x) = edge.at(y + 1, x) = 255;
    }
  constexpr int kReach = kWindowPx / 2;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      if (edge.at(y, x) == 0) continue;
      for (int v = std::max(y - kReach, 0); v <= std::min(y + kReach, h - 1); ++v)
        for (int u = std::max(x - kReach, 0); u <= std::min(x + kReach, w - 1); ++u) out.disc.at(v, u) = out.nonocc.at(v, u);
    }
  return out;
}

Result<std::vector<fs::path>> find_scenes(const std::vector<fs::path>& paths) {
  std::vector<fs::path> scenes;
  for (const fs::path& path : paths) {
    std::error_code error;
    if (fs::is_regular_file(path / "meta.json", error)) {
      scenes.push_back(path);
      continue;
    }
    std::vector<fs::path> inside;
    for (auto it = fs::directory_iterator(path, error); !error && it != fs::directory_iterator(); it.increment(error))
      if (std::error_code ignored; fs::is_regular_file(it->path() / "meta.json", ignored)) inside.push_back(it->path());
    if (error || inside.empty())
      return Error{error ? ErrorCode::kNotFound : ErrorCode::kBadInput,
                   fmt::format("cannot evaluate {}: {}", path.string(),
                               error ? error.message()
                                     : "no scene inside (a folder with left.png, right.png, disp_left.png and meta.json)")};
    std::sort(inside.begin(), inside.end());
    scenes.insert(scenes.end(), inside.begin(), inside.end());
  }
  return scenes;
}

Result<StereoScene> load_scene(const fs::path& folder) {
  DUO_TRY_ASSIGN(const Meta meta, load_meta(folder / "meta.json"));
  StereoScene scene;
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(folder, error);
  scene.name = (error ? folder : whole).filename().string();
  scene.max_disparity = meta.max_disparity;
  DUO_TRY_ASSIGN(scene.pair.left, load_picture(folder / "left.png", {}));
  const Size size = scene.pair.left.pixels.size();
  DUO_TRY_ASSIGN(scene.pair.right, load_picture(folder / "right.png", size));
  DUO_TRY_ASSIGN(scene.truth_px, load_truth(folder / "disp_left.png", size, meta.scale));
  scene.regions = regions_of_truth(scene.truth_px, meta.border_px);
  if (fs::exists(folder / "mask_nonocc.png", error) && fs::exists(folder / "mask_disc.png", error)) {
    DUO_TRY_ASSIGN(scene.regions.nonocc, load_mask(folder / "mask_nonocc.png", scene.regions.all, 255));
    DUO_TRY_ASSIGN(scene.regions.disc, load_mask(folder / "mask_disc.png", scene.regions.all, 255));
  }
  return scene;
}

}  // namespace duo
