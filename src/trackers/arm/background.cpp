#include "trackers/arm/background.h"

#include <algorithm>
#include <cmath>

#include "duoptic/statistics.h"

namespace duo::arm {
namespace {

float& nth_share(std::vector<float>& values, double share) {
  return nth(values, static_cast<std::size_t>(share * static_cast<double>(values.size())));
}

}  // namespace

Background::Background(const Grid& grid) {
  const auto n = static_cast<std::size_t>(grid.size());
  d_px_.resize(n);
  depth_known_.resize(n);
  color_.resize(n);
  color_known_.resize(n);
  same_.resize(n);
  same_color_.resize(n);
  for (auto& s : samples_) s.reserve(n);
}

void Background::start(const Grid& grid, const std::vector<std::uint8_t>& unknown) {
  constexpr int kNear = 5;  // cells: disparity bleeds over the person's outline
  std::vector<std::uint8_t> near(unknown.size());
  for (int i = 0; i < grid.size(); ++i)
    if (unknown[static_cast<std::size_t>(i)])
      each_around(grid, i % grid.width, i / grid.width, kNear, [&](int j) { near[static_cast<std::size_t>(j)] = 1; });

  std::vector<std::uint8_t> with_depth(unknown.size());
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (near[i] || !grid.inside[i]) continue;
    with_depth[i] = grid.z_m[i] > 0;
    color_[i] = grid.color[i];
    color_known_[i] = Known::kSeen;
  }
  constexpr double kStepM = 0.05;
  constexpr std::size_t kLeastCells = 250;  // specks on bare walls are no background
  Regions regions(grid);
  for (const Region& r : regions.find(grid, with_depth, kStepM)) {
    if (r.cells.size() <= kLeastCells) continue;
    for (const int i : r.cells) {
      d_px_[static_cast<std::size_t>(i)] = static_cast<float>(grid.camera.disparity_px(grid.z(i)));
      depth_known_[static_cast<std::size_t>(i)] = 1;
    }
  }
  guess_color(grid);
  guess_depth(grid);
}

// Behind the person: the farther of what is known to the left and to the right, else of above and below.
void Background::guess_depth(const Grid& grid) {
  constexpr std::size_t kSamples = 15;
  constexpr double kFar = 0.25;  // quantile of disparity
  const int w = grid.width, h = grid.height;
  std::vector<float> guess = d_px_, samples;
  const auto farther = [](float a, float b) { return a > 0 && b > 0 ? std::min(a, b) : a + b; };
  const auto look = [&](int x, int y, int direction) {
    samples.clear();
    for (int u = x; u >= 0 && u < w && samples.size() < kSamples; u += direction)
      for (int v = std::max(0, y - 2); v <= std::min(h - 1, y + 2); v += 2)
        if (depth_known_[static_cast<std::size_t>(grid.at(u, v))])
          samples.push_back(d_px_[static_cast<std::size_t>(grid.at(u, v))]);
    return samples.empty() ? 0.0F : nth_share(samples, kFar);
  };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      if (const auto i = static_cast<std::size_t>(grid.at(x, y)); !depth_known_[i])
        guess[i] = farther(look(x, y, -1), look(x, y, 1));

  const auto column = [&](int x, int y, int direction) {
    for (; y >= 0 && y < h; y += direction)
      if (const float d = guess[static_cast<std::size_t>(grid.at(x, y))]; d > 0) return d;
    return 0.0F;
  };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const auto i = static_cast<std::size_t>(grid.at(x, y));
      d_px_[i] = guess[i] > 0 ? guess[i] : farther(column(x, y, -1), column(x, y, 1));
    }
}

// Behind the person: linear between the medians of the cells known to the left and to the right.
void Background::guess_color(const Grid& grid) {
  constexpr int kSamples = 5;
  const auto seen = [&](int x, int y) { return color_known_[static_cast<std::size_t>(grid.at(x, y))] == Known::kSeen; };
  const auto look = [&](int x, int y, int direction, Rgb& out) {
    std::vector<float> c[3];
    for (; x >= 0 && x < grid.width && c[0].size() < kSamples && seen(x, y); x += direction) {
      const Rgb q = color_[static_cast<std::size_t>(grid.at(x, y))];
      c[0].push_back(q.r);
      c[1].push_back(q.g);
      c[2].push_back(q.b);
    }
    if (c[0].size() < 3) return false;
    out = {nth_share(c[0], 0.5), nth_share(c[1], 0.5), nth_share(c[2], 0.5)};
    return true;
  };
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width;) {
      const auto gap = [&](int u) {
        return u < grid.width && grid.inside[static_cast<std::size_t>(grid.at(u, y))] && !seen(u, y);
      };
      if (!gap(x)) {
        ++x;
        continue;
      }
      int end = x;
      while (gap(end)) ++end;
      Rgb a, b;
      const bool left = look(x - 1, y, -1, a), right = look(end, y, 1, b);
      if (!left) a = b;
      if (!right) b = a;
      for (int u = x; u < end && (left || right); ++u) {
        const float t = static_cast<float>(u - x + 1) / static_cast<float>(end - x + 1);
        const auto i = static_cast<std::size_t>(grid.at(u, y));
        color_[i] = {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)};
        color_known_[i] = Known::kGuessed;
      }
      x = end;
    }
}

bool Background::nearer(const Grid& grid, int i) const {
  constexpr double kLeastStepPx = 0.75, kLeastStepM = 0.05;
  if (!grid.known(i)) return false;
  const double d0 = d_px_[static_cast<std::size_t>(i)];
  if (!(d0 > 0)) return true;
  const double fb = grid.camera.focal_px * grid.camera.baseline_m;
  const double margin = std::max(kLeastStepPx / grid.step, kLeastStepM * d0 * d0 / fb);
  return fb / grid.z(i) > d0 + margin;
}

bool Background::is_reference(const Grid& grid, int i) const {
  const auto k = static_cast<std::size_t>(i);
  return color_known_[k] == Known::kSeen && !(depth_known_[k] && nearer(grid, i));
}

float Background::color_step(const Grid& grid, int i) const {
  const Rgb now = grid.color[static_cast<std::size_t>(i)], then = color_[static_cast<std::size_t>(i)];
  const float r = now.r - gain_.r * then.r, g = now.g - gain_.g * then.g, b = now.b - gain_.b * then.b;
  return std::sqrt((r * r + g * g + b * b) / 3);
}

// The light's gain is the median over cells that are background by depth; the noise left tells which step means another
// surface.
void Background::observe_light(const Grid& grid) {
  constexpr std::size_t kLeastSamples = 50;
  constexpr float kBlack = 20, kDark = 8;  // levels: darker cells say nothing about gain
  constexpr int kEvery = 7;                // cells: thousands are left
  for (auto& s : samples_) s.clear();
  for (int i = 0; i < grid.size(); i += kEvery) {
    const Rgb now = grid.color[static_cast<std::size_t>(i)], then = color_[static_cast<std::size_t>(i)];
    if (then.r <= kBlack || !is_reference(grid, i)) continue;
    samples_[0].push_back(now.r / std::max(kDark, then.r));
    samples_[1].push_back(now.g / std::max(kDark, then.g));
    samples_[2].push_back(now.b / std::max(kDark, then.b));
  }
  if (samples_[0].size() > kLeastSamples)
    gain_ = {nth_share(samples_[0], 0.5), nth_share(samples_[1], 0.5), nth_share(samples_[2], 0.5)};

  samples_[0].clear();
  for (int i = 0; i < grid.size(); i += kEvery)
    if (is_reference(grid, i)) samples_[0].push_back(color_step(grid, i));
  const float noise = samples_[0].size() > kLeastSamples ? nth_share(samples_[0], 0.5) : 3;
  color_limit_ = std::clamp(2.5F * noise, 4.0F, 10.0F);
}

void Background::observe(const Grid& grid) {
  constexpr float kGuessLimit = 6;  // levels: a guessed colour proves less
  constexpr int kMostly = 6;        // of 3 x 3
  observe_light(grid);
  for (std::size_t i = 0; i < same_.size(); ++i) {
    const float limit = color_known_[i] == Known::kSeen ? color_limit_ : std::min(color_limit_, kGuessLimit);
    same_[i] = color_known_[i] != Known::kNothing && color_step(grid, static_cast<int>(i)) < limit;
  }
  const int w = grid.width, h = grid.height;
  for (int y = 0; y < h; ++y) {
    const std::uint8_t* rows[3] = {&same_[static_cast<std::size_t>(std::max(0, y - 1) * w)],
                                   &same_[static_cast<std::size_t>(y * w)],
                                   &same_[static_cast<std::size_t>(std::min(h - 1, y + 1) * w)]};
    for (int x = 0; x < w; ++x) {
      const int left = std::max(0, x - 1), right = std::min(w - 1, x + 1);
      int set = 0;
      for (const std::uint8_t* row : rows) set += row[left] + row[x] + row[right];
      same_color_[static_cast<std::size_t>(grid.at(x, y))] = set >= kMostly;
    }
  }
}

// Farther things are learnt fast, nearer ones slowly: a person who stands still for a while does not become furniture.
void Background::update(const Grid& grid) {
  constexpr float kFarther = 0.1F, kFartherThanGuess = 0.4F, kNearer = 0.05F, kColor = 0.15F;
  for (int i = 0; i < grid.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const bool behind = grid.known(i) && !nearer(grid, i);
    if (behind && d_px_[k] > 0) {
      const float step = static_cast<float>(grid.camera.disparity_px(grid.z(i))) - d_px_[k];
      d_px_[k] += (step >= 0 ? kNearer : depth_known_[k] ? kFarther : kFartherThanGuess) * step;
      depth_known_[k] = 1;
    }
    Rgb& c = color_[k];
    if (grid.inside[k] && (behind || same_color_[k])) {
      const float rate = color_known_[k] == Known::kSeen ? kColor : 1;
      color_known_[k] = Known::kSeen;
      const Rgb now = grid.color[k];
      c = {c.r + rate * (now.r - c.r), c.g + rate * (now.g - c.g), c.b + rate * (now.b - c.b)};
    } else if (color_known_[k] != Known::kNothing) {
      c = {c.r * (1 + kColor * (gain_.r - 1)), c.g * (1 + kColor * (gain_.g - 1)), c.b * (1 + kColor * (gain_.b - 1))};
    }
  }
}

}  // namespace duo::arm
