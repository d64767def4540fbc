#include "calib/report_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/coded_picture.h"

extern "C" {
#include <libavutil/base64.h>
}

namespace duo {
namespace {

constexpr const char *kInk = "#1f2933", *kFaintInk = "#9aa5b1", *kCalm = "#2f6fb5", *kLoud = "#e07a1f", *kWrong = "#c62828";

const std::vector<BoardCorner>& corners_of(const BoardView& view, int camera) { return camera == 0 ? view.left : view.right; }

double error_px(const BoardCorner& c) { return std::hypot(c.dx_px, c.dy_px); }

double rms_px(const Calibration& calibration, int camera) {
  return std::max(1e-6, camera == 0 ? calibration.rig.errors.left_px : calibration.rig.errors.right_px);
}

/// Both cameras are drawn on one scale.
double larger_rms_px(const Calibration& calibration) { return std::max(rms_px(calibration, 0), rms_px(calibration, 1)); }

std::string opened(double width, double height) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.6g} {1:.6g}\">"
      "<rect width=\"{0:.6g}\" height=\"{1:.6g}\" class=\"ground\"/>",
      width, height);
}

std::string words(double x, double y, double size, const char* anchor, const char* color, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\">{}</text>", x, y,
                     size, anchor, color, text);
}

/// 1, 2 or 5 times a power of ten, the nearest below.
double round_below(double value) {
  const double ten = std::pow(10, std::floor(std::log10(value)));
  return value >= 5 * ten ? 5 * ten : value >= 2 * ten ? 2 * ten : ten;
}

/// Colours far from each other for neighbouring numbers.
std::string color_of_view(std::size_t number) {
  return fmt::format("hsl({:.0f},65%,42%)", std::fmod(137.5 * static_cast<double>(number), 360));
}

std::string outline(const std::vector<BoardCorner>& corners) {
  std::vector<cv::Point2f> points, hull;
  for (const BoardCorner& c : corners) points.emplace_back(static_cast<float>(c.x_px), static_cast<float>(c.y_px));
  if (!points.empty()) cv::convexHull(points, hull);
  std::string out;
  for (const cv::Point2f& p : hull) out += fmt::format("{:.1f},{:.1f} ", p.x, p.y);
  return out;
}

/// A picture as JPEG in text.
Result<std::string> jpeg_text(const Image<Rgb8>& picture) {
  const cv::Mat rgb(picture.height(), picture.width(), CV_8UC3, const_cast<Rgb8*>(picture.row(0)),
                    static_cast<std::size_t>(picture.stride()) * sizeof(Rgb8));
  constexpr int kWidest = 960, kQuality = 85;
  cv::Mat small = rgb;
  if (rgb.cols > kWidest) cv::resize(rgb, small, {}, double(kWidest) / rgb.cols, double(kWidest) / rgb.cols, cv::INTER_AREA);
  const View<const Rgb8> pixels(small.ptr<Rgb8>(), {small.cols, small.rows},
                                static_cast<std::ptrdiff_t>(small.step / sizeof(Rgb8)));
  const std::string bytes = jpeg_of(pixels, kQuality);
  if (bytes.empty()) return Error{ErrorCode::kWriteFailed, "cannot encode the rectified pair as JPEG"};
  std::string text(AV_BASE64_SIZE(bytes.size()), '\0');
  av_base64_encode(text.data(), static_cast<int>(text.size()), reinterpret_cast<const std::uint8_t*>(bytes.data()),
                   static_cast<int>(bytes.size()));
  text.resize(text.find('\0'));
  return text;
}

}  // namespace

std::string html_of(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

std::string coverage_svg(const Calibration& calibration, int camera) {
  constexpr int kAcross = 12, kDown = 9;
  const auto [width, height] = camera == 0 ? calibration.rig.left.size : calibration.rig.right.size;
  const double cell_x = double(width) / kAcross, cell_y = double(height) / kDown;
  std::array<bool, kAcross * kDown> seen{};
  std::string views;
  std::size_t number = 0;
  for (const BoardView& view : calibration.views) {
    if (corners_of(view, camera).empty()) continue;
    const std::string color = view.used ? color_of_view(number++) : kFaintInk;
    views += fmt::format("<polygon points=\"{}\" fill=\"{}\" fill-opacity=\"{}\" stroke=\"{}\" stroke-width=\"{:.2f}\" {}/>",
                         outline(corners_of(view, camera)), color, view.used ? 0.05 : 0, color, width / 500.0,
                         view.used ? "" : "stroke-dasharray=\"6 6\"");
    for (const BoardCorner& c : corners_of(view, camera)) {
      views +=
          fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.2f}\" fill=\"{}\"/>", c.x_px, c.y_px, width / 320.0, color);
      if (!view.used) continue;
      const int x = std::clamp(static_cast<int>(c.x_px / cell_x), 0, kAcross - 1);
      const int y = std::clamp(static_cast<int>(c.y_px / cell_y), 0, kDown - 1);
      seen[static_cast<std::size_t>(y * kAcross + x)] = true;
    }
  }
  std::string out = opened(width, height);
  for (int i = 0; i < kAcross * kDown; ++i)
    if (!seen[static_cast<std::size_t>(i)])
      out +=
          fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\" fill-opacity=\"0.09\"/>",
                      i % kAcross * cell_x, i / kAcross * cell_y, cell_x, cell_y, kWrong);
  return out + views + "</svg>";
}

std::string residuals_svg(const Calibration& calibration, int camera) {
  const auto [width, height] = camera == 0 ? calibration.rig.left.size : calibration.rig.right.size;
  const double rms = rms_px(calibration, camera), factor = round_below(width / 40.0 / larger_rms_px(calibration));
  std::string out = opened(width, height);
  for (const BoardView& view : calibration.views) {
    if (!view.used) continue;
    for (const BoardCorner& c : corners_of(view, camera))
      out += fmt::format(
          "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" stroke-width=\"{:.2f}\"/>"
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.2f}\" fill=\"{}\"/>",
          c.x_px, c.y_px, c.x_px + factor * c.dx_px, c.y_px + factor * c.dy_px, error_px(c) > 2.5 * rms ? kLoud : kCalm,
          width / 450.0, c.x_px, c.y_px, width / 450.0, error_px(c) > 2.5 * rms ? kLoud : kCalm);
  }
  const double size = width / 32.0, bar = factor * 0.2, x = width / 50.0, y = height - width / 40.0;
  out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#fff\" fill-opacity=\"0.85\"/>",
                     x / 2, y - size, bar + 3.6 * size + x, 1.5 * size);
  out +=
      fmt::format("<line x1=\"{0:.1f}\" x2=\"{1:.1f}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\" stroke=\"{3}\" stroke-width=\"{4:.2f}\"/>",
                  x, x + bar, y - size / 3, kInk, width / 250.0);
  return out + words(x + bar + size / 2, y, size, "start", kInk, "0.2 px") + "</svg>";
}

std::string scatter_svg(const Calibration& calibration, int camera) {
  constexpr double kWide = 480, kHigh = 320, kX = kWide / 2, kY = kHigh / 2, kReach = 145;
  const double rms = rms_px(calibration, camera), range = round_below(8 * larger_rms_px(calibration)), scale = kReach / range;
  std::string out = opened(kWide, kHigh);
  out += fmt::format("<path d=\"M{} {}h{}M{} {}v{}\" stroke=\"{}\" fill=\"none\"/>", kX - kReach, kY, 2 * kReach, kX,
                     kY - kReach, 2 * kReach, kFaintInk);
  for (const BoardView& view : calibration.views) {
    if (!view.used) continue;
    for (const BoardCorner& c : corners_of(view, camera)) {
      const double x = std::clamp(c.dx_px, -range, range), y = std::clamp(c.dy_px, -range, range);
      out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.6\" fill=\"{}\" fill-opacity=\"0.45\"/>", kX + scale * x,
                         kY + scale * y, error_px(c) > 2.5 * rms ? kLoud : kCalm);
    }
  }
  out += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{:.1f}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.2\"/>", kX, kY,
                     scale * rms, kInk);
  out += words(kX + kReach, kY - 5, 12, "end", kInk, fmt::format("{:.4g} px", range));
  return out + words(10, kHigh - 10, 12, "start", kInk, fmt::format("circle: {:.3f} px rms", rms)) + "</svg>";
}

std::string views_svg(const Calibration& calibration) {
  constexpr double kWidth = 960, kHeight = 190, kLeft = 50, kBase = 160, kTop = 15;
  std::vector<std::array<double, 2>> bars;
  std::vector<std::string> names;
  double highest = 0;
  for (const BoardView& view : calibration.views) {
    if (!view.used) continue;
    std::array<double, 2> both{};
    for (const int camera : {0, 1}) {
      double sum = 0;
      for (const BoardCorner& c : corners_of(view, camera)) sum += error_px(c) * error_px(c);
      both[static_cast<std::size_t>(camera)] =
          std::sqrt(sum / std::max<double>(1, static_cast<double>(corners_of(view, camera).size())));
      highest = std::max(highest, both[static_cast<std::size_t>(camera)]);
    }
    bars.push_back(both);
    names.push_back(view.name);
  }
  const double step_px = round_below(std::max(0.01, highest / 2)), top_px = step_px * std::ceil(highest / step_px);
  const auto y_of = [&](double px) { return kBase - (kBase - kTop) * px / top_px; };
  std::string out = opened(kWidth, kHeight);
  for (double px = 0; px < top_px + step_px / 2; px += step_px) {
    out += fmt::format("<path d=\"M{} {:.1f}H{}\" stroke=\"#d9dee4\" fill=\"none\"/>", kLeft, y_of(px), kWidth - 10);
    out += words(kLeft - 6, y_of(px) + 4, 12, "end", kInk, fmt::format("{:.4g}", px));
  }
  const double pitch = (kWidth - kLeft - 10) / static_cast<double>(bars.size()), bar = std::min(0.36 * pitch, 18.0);
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const double middle = kLeft + pitch * (static_cast<double>(i) + 0.5);
    for (const std::size_t camera : {0u, 1u})
      out += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"><title>{}: {:.3f} px</title></rect>",
          camera == 0 ? middle - bar : middle, y_of(bars[i][camera]), bar, kBase - y_of(bars[i][camera]),
          camera == 0 ? kCalm : "#8ab4dd", html_of(names[i]), bars[i][camera]);
    if (bars.size() <= 40) out += words(middle, kBase + 16, 11, "middle", kInk, std::to_string(i + 1));
  }
  return out + "</svg>";
}

Result<std::string> rows_svg(const Rig& rig, const Pair& pair) {
  DUO_TRY_ASSIGN(const Pair rectified, rectify_pair(rig, pair));
  const auto [width, height] = rectified.left.pixels.size();
  const double gap = width / 80.0;
  std::string out = opened(2 * width + gap, height);
  for (const bool left : {true, false}) {
    DUO_TRY_ASSIGN(const std::string jpeg, jpeg_text(left ? rectified.left.pixels : rectified.right.pixels));
    out += fmt::format("<image x=\"{:.2f}\" width=\"{}\" height=\"{}\" href=\"data:image/jpeg;base64,{}\"/>",
                       left ? 0 : width + gap, width, height, jpeg);
  }
  constexpr int kLines = 14;
  for (int i = 1; i < kLines; ++i)
    out += fmt::format("<path d=\"M0 {0:.1f}H{1:.1f}\" stroke=\"{2}\" stroke-width=\"{3:.2f}\"/>", double(height) * i / kLines,
                       2 * width + gap, i % 2 == 0 ? "#ffb000" : "#00d0c8", width / 640.0);
  return out + "</svg>";
}

}  // namespace duo
