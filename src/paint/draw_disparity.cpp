#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/check.h"
#include "duoptic/paint.h"
#include "duoptic/statistics.h"
#include "paint/legend.h"
#include "paint/turbo.h"

namespace duo {
namespace {

double position(const DisparityRange& range, double d_px) { return (d_px - range.far_px) / (range.near_px - range.far_px); }

/// The ends of the map are left out: its first colours look black, which stands for none.
Rgb8 color_at(double position) { return turbo(0.06 + 0.91 * std::clamp(position, 0.0, 1.0)); }

/// The other maps, from far to near; the first grays are left out, too.
std::array<Rgb8, 256> steps_of(DepthColors colors) {
  std::array<Rgb8, 256> out;
  cv::Mat ramp(1, 256, CV_8UC1), bgr;
  for (int i = 0; i < 256; ++i) ramp.at<std::uint8_t>(0, i) = static_cast<std::uint8_t>(i);
  cv::applyColorMap(ramp, bgr, cv::COLORMAP_CIVIDIS);
  for (int i = 0; i < 256; ++i) {
    const auto gray = static_cast<std::uint8_t>(40 + i * 215 / 255);
    const auto& c = bgr.at<cv::Vec3b>(0, i);
    out[static_cast<std::size_t>(i)] = colors == DepthColors::kGray ? Rgb8{gray, gray, gray} : Rgb8{c[2], c[1], c[0]};
  }
  return out;
}

struct Tick {
  double d_px;
  std::string label;
};

/// Round values in the order of importance: what fits first, stays.
std::vector<Tick> ticks(const DisparityRange& range, const Rectified* rectified) {
  std::vector<Tick> out;
  for (const double leading :
       {1.0, 2.0, 5.0, 3.0, 1.5, 4.0, 7.0, 2.5, 6.0, 8.0, 9.0, 1.2, 1.4, 1.6, 1.8, 1.1, 1.3, 1.7, 2.2, 3.5, 4.5})
    for (const double power : {1.0, 10.0, 100.0, 0.1, 0.01, 1000.0}) {
      const double value = leading * power;
      if (!rectified && value != std::floor(value)) continue;
      const double d_px = rectified ? rectified->disparity_px(value) : value;
      if (d_px >= range.far_px && d_px <= range.near_px)
        out.push_back({d_px, fmt::format("{:.3g} {}", value, rectified ? "m" : "px")});
    }
  return out;
}

}  // namespace

DisparityRange disparity_range(View<const std::uint16_t> d_q4) {
  std::vector<std::uint16_t> known;
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < d_q4.width(); ++x)
      if (d_q4.at(y, x) != Disparity::kNone) known.push_back(d_q4.at(y, x));
  if (known.empty()) return {};
  const double far_px = quantile(known, 0.01) / 16.0, near_px = quantile(known, 0.99) / 16.0;
  return {far_px, std::max(near_px, far_px + 1)};
}

DisparityRange roomy_range(View<const std::uint16_t> d_q4, double nearer) {
  constexpr double kFarther = 3;
  const DisparityRange range = disparity_range(d_q4);
  return range.empty() ? range : DisparityRange{std::max(range.far_px, range.near_px / kFarther), range.near_px * nearer};
}

// A table, because there are far fewer disparities than pixels.
void color_disparity(View<const std::uint16_t> d_q4, const DisparityRange& range, View<Rgb8> dst, DepthColors of) {
  DUO_CHECK(d_q4.size() == dst.size());
  const auto steps = of == DepthColors::kTurbo ? std::array<Rgb8, 256>{} : steps_of(of);
  const auto color = [&](double d_px) {
    const double at = std::clamp(position(range, d_px), 0.0, 1.0);
    return of == DepthColors::kTurbo ? color_at(at) : steps[static_cast<std::size_t>(255 * at + 0.5)];
  };
  std::vector<Rgb8> colors(Disparity::kNone + 1u);
  const auto near_q4 =
      range.empty() ? 0u : std::min<unsigned>(static_cast<unsigned>(std::max(0.0, 16 * range.near_px)) + 1, Disparity::kNone);
  for (unsigned d = 0; d < near_q4; ++d) colors[d] = color(d / 16.0);
  if (!range.empty()) std::fill(colors.begin() + near_q4, colors.end() - 1, color(range.near_px));
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < d_q4.width(); ++x) dst.at(y, x) = colors[d_q4.at(y, x)];
}

void draw_unmatched(const Frame& frame, View<Rgb8> dst) {
  constexpr int kDarker = 3;
  constexpr Rgb8 kLine = {225, 225, 225};
  const Window& matched = frame.matched;
  DUO_CHECK(frame.disparity.d_q4.size() == dst.size());
  if (matched.empty()) return;
  const Window inner = {matched.x + 1, matched.y + 1, matched.width - 2, matched.height - 2};
  for (int y = 0; y < dst.height(); ++y)
    for (int x = 0; x < dst.width(); ++x) {
      if (inner.contains(y, x)) continue;
      const auto gray = static_cast<std::uint8_t>(frame.left.empty() ? 0 : frame.left.at(y, x) / kDarker);
      dst.at(y, x) = matched.contains(y, x) ? kLine : Rgb8{gray, gray, gray};
    }
}

void draw_legend(View<Rgb8> dst, const DisparityRange& range, const Rectified* rectified) {
  const cv::Mat rgb(dst.height(), dst.width(), CV_8UC3, dst.data(), static_cast<std::size_t>(dst.stride()) * sizeof(Rgb8));
  const double zoom = rgb.rows / 44.0;
  const int margin = static_cast<int>(10 * zoom), bar_top = static_cast<int>(7 * zoom),
            bar_bottom = static_cast<int>(21 * zoom);
  const int bar_width = rgb.cols - 2 * margin;
  if (bar_width < 2) return;
  const double font = 0.42 * zoom;
  const int thickness = std::max(1, static_cast<int>(zoom));
  const auto text = [&](const std::string& label, int left) {
    cv::putText(rgb, label, {left, static_cast<int>(38 * zoom)}, cv::FONT_HERSHEY_SIMPLEX, font, {225, 225, 225}, thickness,
                cv::LINE_AA);
  };
  if (range.empty()) return text("no disparity", margin);
  for (int x = 0; x < bar_width; ++x) {
    const Rgb8 c = color_at(static_cast<double>(x) / (bar_width - 1));
    cv::line(rgb, {margin + x, bar_top}, {margin + x, bar_bottom}, {double(c.r), double(c.g), double(c.b)});
  }
  std::vector<std::pair<int, int>> taken;  // labels drawn, from left to right end
  for (const Tick& tick : ticks(range, rectified)) {
    const int x = margin + static_cast<int>(position(range, tick.d_px) * (bar_width - 1));
    const int width = cv::getTextSize(tick.label, cv::FONT_HERSHEY_SIMPLEX, font, thickness, nullptr).width;
    const int left = x - width / 2, gap = static_cast<int>(8 * zoom);
    const bool fits = left >= 0 && left + width <= rgb.cols && std::none_of(taken.begin(), taken.end(), [&](const auto& other) {
                        return left < other.second + gap && other.first < left + width + gap;
                      });
    if (!fits) continue;
    taken.emplace_back(left, left + width);
    cv::line(rgb, {x, bar_bottom}, {x, bar_bottom + static_cast<int>(4 * zoom)}, {225, 225, 225}, thickness);
    text(tick.label, left);
  }
}

Image<Rgb8> draw_disparity(View<const std::uint16_t> d_q4, const Rectified* rectified) {
  const int legend_height = std::max(44, 44 * d_q4.width() / 640);
  Image<Rgb8> out({d_q4.width(), d_q4.height() + legend_height});
  const DisparityRange range = disparity_range(d_q4);
  color_disparity(d_q4, range, out.view().crop(0, 0, d_q4.size()));
  draw_legend(out.view().crop(d_q4.height(), 0, {d_q4.width(), legend_height}), range, rectified);
  return out;
}

Image<Rgb8> depth_strip(DepthColors colors) {
  constexpr int kSteps = 256;
  Image<std::uint16_t> ramp({kSteps, 1});
  for (int x = 0; x < kSteps; ++x) ramp.at(0, x) = static_cast<std::uint16_t>(x * 16);
  Image<Rgb8> out(ramp.size());
  color_disparity(ramp, {0, kSteps - 1.0}, out, colors);
  return out;
}

}  // namespace duo
