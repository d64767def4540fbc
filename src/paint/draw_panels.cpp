#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <string_view>

#include "core/check.h"
#include "duoptic/paint.h"
#include "paint/hue.h"
#include "paint/legend.h"

namespace duo {
namespace {

const cv::Scalar kText(228, 228, 228), kFaint(140, 140, 140), kBox(60, 230, 80), kBone(235, 45, 40), kFinger(255, 205, 60);
constexpr Rgb8 kGround = {18, 20, 24};
constexpr int kFace = cv::FONT_HERSHEY_SIMPLEX;

/// Four cells: a title, a picture as wide as the raw one but at most kMaxWidth, and a caption.
struct Layout {
  static constexpr int kMaxWidth = 640;
  Size picture;
  int title_px, caption_px, gap_px;

  explicit Layout(Size raw) {
    picture.width = std::max(2, std::min(raw.width, kMaxWidth) & ~1);
    picture.height = std::max(2, static_cast<int>(std::int64_t{raw.height} * picture.width / std::max(raw.width, 1)) & ~1);
    title_px = scaled(28);
    caption_px = scaled(46);
    gap_px = scaled(4);
  }
  int scaled(int px_at_full_width) const { return std::max(2, px_at_full_width * picture.width / kMaxWidth & ~1); }
  double font() const { return 0.5 * picture.width / kMaxWidth; }
  int stroke() const { return 1; }
  Size whole() const { return {2 * picture.width + gap_px, 2 * (title_px + picture.height + caption_px) + gap_px}; }
};

cv::Mat mat_of(View<Rgb8> picture) {
  return {picture.height(), picture.width(), CV_8UC3, picture.data(),
          static_cast<std::size_t>(picture.stride()) * sizeof(Rgb8)};
}

/// One of the four, cut into its three parts.
struct Cell {
  View<Rgb8> title, picture, caption;

  Cell(View<Rgb8> whole, const Layout& layout, int row, int column) {
    const int x = column * (layout.picture.width + layout.gap_px), w = layout.picture.width;
    int y = row * (layout.title_px + layout.picture.height + layout.caption_px + layout.gap_px);
    title = whole.crop(y, x, {w, layout.title_px});
    picture = whole.crop(y += layout.title_px, x, layout.picture);
    caption = whole.crop(y + layout.picture.height, x, {w, layout.caption_px});
  }
};

enum class Align { kLeft, kRight };

void put_text(View<Rgb8> dst, const std::string& text, cv::Point at, const cv::Scalar& color, const Layout& layout,
              Align align = Align::kLeft) {
  if (align == Align::kRight) at.x -= cv::getTextSize(text, kFace, layout.font(), layout.stroke(), nullptr).width;
  cv::putText(mat_of(dst), text, at, kFace, layout.font(), color, layout.stroke(), cv::LINE_AA);
}

void put_title(const Cell& cell, const Layout& layout, const std::string& left, const std::string& right) {
  const int base = layout.scaled(20), margin = layout.scaled(10);
  put_text(cell.title, left, {margin, base}, kText, layout);
  put_text(cell.title, right, {cell.title.width() - margin, base}, kFaint, layout, Align::kRight);
}

/// Scales `src` into `dst`, whole, with the ground left beside or above it where the shapes differ.
void fit(View<Rgb8> src, View<Rgb8> dst) {
  constexpr double kCoarse = 0.7;  // from here on pixels are left out, and have to be averaged instead
  const double scale =
      std::min(static_cast<double>(dst.width()) / src.width(), static_cast<double>(dst.height()) / src.height());
  const Size size = {std::clamp(static_cast<int>(std::lround(src.width() * scale)), 1, dst.width()),
                     std::clamp(static_cast<int>(std::lround(src.height() * scale)), 1, dst.height())};
  cv::Mat into = mat_of(dst.crop((dst.height() - size.height) / 2, (dst.width() - size.width) / 2, size));
  cv::resize(mat_of(src), into, into.size(), 0, 0, scale < kCoarse ? cv::INTER_AREA : cv::INTER_LINEAR);
}

void broken_line(cv::Mat& rgb, cv::Point2d a, cv::Point2d b, const cv::Scalar& color, int thickness, double dash_px) {
  const cv::Point2d along = b - a;
  const double length = std::hypot(along.x, along.y);
  for (double at = 0; at < length; at += 2 * (dash_px + thickness)) {  // round ends make a dash longer
    const double end = std::min(at + dash_px, length);
    cv::line(rgb, a + along * (at / length), a + along * (end / length), color, thickness, cv::LINE_AA);
  }
}

/// Shapes over the raw left picture, scaled into `dst`.
void stroke(const Shapes& shapes, View<Rgb8> dst, const TrackHeader& header, const Layout& layout) {
  cv::Mat rgb = mat_of(dst);
  const double scale = static_cast<double>(dst.width()) / header.size.width;
  const int thick = layout.scaled(4);
  const double dash_px = layout.scaled(8);
  const auto place = [&](double x_px, double y_px) {
    return cv::Point2d((x_px + 0.5) * scale - 0.5, (y_px + 0.5) * scale - 0.5);
  };
  for (const Shapes::Line& bone : shapes.bones) {
    if (bone.thin) continue;
    const cv::Point2d a = place(bone.x0_px, bone.y0_px), b = place(bone.x1_px, bone.y1_px);
    if (bone.broken)
      broken_line(rgb, a, b, kBone, thick, dash_px);
    else
      cv::line(rgb, a, b, kBone, thick, cv::LINE_AA);
  }
  for (const Shapes::Mark& joint : shapes.joints) {
    const double half = scale * joint.half_px;
    const cv::Point2d c = place(joint.x_px, joint.y_px), dx(half, 0), dy(0, half);
    const cv::Point2d corners[] = {c - dx - dy, c + dx - dy, c + dx + dy, c - dx + dy};
    if (joint.broken) {
      for (std::size_t i = 0; i < 4; ++i) broken_line(rgb, corners[i], corners[(i + 1) % 4], kBox, thick - 1, dash_px / 2);
      continue;
    }
    cv::rectangle(rgb, corners[0], corners[2], kBox, thick - 1, cv::LINE_AA);
    cv::circle(rgb, c, thick, kBox, cv::FILLED, cv::LINE_AA);
  }
  for (const Shapes::Line& bone : shapes.bones)  // over the boxes of hands
    if (bone.thin)
      cv::line(rgb, place(bone.x0_px, bone.y0_px), place(bone.x1_px, bone.y1_px), bone.broken ? kFaint : kFinger,
               std::max(thick / 2, 1), cv::LINE_AA);
}

/// "hand 1.32 m +-2 cm" for each joint; a line per person.
void put_labels(View<Rgb8> dst, std::span<const Person> people, bool metric, const Layout& layout) {
  static const cv::Scalar kColors[] = {kBox, {250, 190, 60}, kFaint};
  constexpr std::size_t kMostLines = 2;
  for (std::size_t n = 0; n < people.size() && n < kMostLines; ++n) {
    const std::vector<Label> labels = labels_of(people[n], metric);
    int end = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const std::string text = labels[i].text + (labels[i].sigma.empty() ? "" : " +-" + labels[i].sigma);
      const int column =
          layout.scaled(10) + static_cast<int>(i) * (dst.width() - layout.scaled(20)) / static_cast<int>(labels.size());
      const int x = std::max(column, end);  // beyond the column of a long one before
      end = x + layout.scaled(10) + cv::getTextSize(text, kFace, layout.font(), layout.stroke(), nullptr).width;
      put_text(dst, text, {x, layout.scaled(people.size() > 1 ? 18 : 26) + static_cast<int>(n) * layout.scaled(20)},
               kColors[static_cast<std::size_t>(labels[i].state)], layout);
    }
  }
}

void put_shades(View<Rgb8> dst, const TrackHeader& header, const Layout& layout) {
  int x = layout.scaled(10);
  for (const ShadeKey& key : shade_keys(header)) {
    for (const JointId joint : key.joints) {
      const Rgb8 c = shade_of(joint);
      cv::rectangle(mat_of(dst), cv::Rect(x, layout.scaled(14), layout.scaled(18), layout.scaled(16)),
                    cv::Scalar(c.r, c.g, c.b), cv::FILLED);
      x += layout.scaled(18);
    }
    put_text(dst, key.name, {x + layout.scaled(8), layout.scaled(28)}, kText, layout);
    x += layout.scaled(102);
  }
}

void put_hues(View<Rgb8> dst, const Layout& layout) {
  const int margin = layout.scaled(10), top = layout.scaled(8), bottom = layout.scaled(22), width = dst.width() - 2 * margin;
  for (int x = 0; x < width; ++x)
    for (int y = top; y < bottom; ++y) dst.at(y, margin + x) = color_of_hue(256 * x / width);
  for (const int degrees : {0, 60, 120, 180, 240, 300})
    put_text(dst, std::to_string(degrees), {margin + degrees * width / 360, layout.scaled(40)}, kText, layout);
}

}  // namespace

Size panels_size(const TrackHeader& header) { return Layout(header.size).whole(); }

Image<Rgb8> draw_panels(const TrackedFrame& frame, const TrackHeader& header, const DisparityRange& range) {
  DUO_CHECK(frame.left->pixels.size() == header.size && frame.frame->color.size() == frame.frame->disparity.d_q4.size());
  const Layout layout(header.size);
  Image<Rgb8> out(layout.whole());
  for (int y = 0; y < out.height(); ++y) std::fill_n(out.row(y), out.width(), kGround);
  const Cell camera(out, layout, 0, 0), depth(out, layout, 0, 1), region(out, layout, 1, 0), hue(out, layout, 1, 1);

  fit(frame.left->pixels.clone(), camera.picture);
  stroke(shapes_of(frame.people, header), camera.picture, header, layout);
  put_title(camera, layout, "left camera: joints and bones", fmt::format("frame {}   {:.2f} s", frame.number, frame.t_s));
  put_labels(camera.caption, frame.people, header.metric, layout);

  Image<Rgb8> drawn(frame.frame->color.size());
  color_disparity(frame.frame->disparity.d_q4, range, drawn);
  draw_unmatched(*frame.frame, drawn);
  fit(drawn, depth.picture);
  put_title(depth, layout, "depth", frame.frame->matched.empty() ? "metres" : "metres; gray: not matched");
  draw_legend(depth.caption, range, header.metric ? &header.rectified : nullptr);

  draw_regions(*frame.frame, header.rectified, frame.people, drawn);
  fit(drawn, region.picture);
  put_title(region, layout, "body", "by nearest joint");
  put_shades(region.caption, header, layout);

  draw_hue(frame.frame->color, drawn);
  fit(drawn, hue.picture);
  put_title(hue, layout, "hue and saturation", "hue, degrees; brightness = saturation");
  put_hues(hue.caption, layout);
  return out;
}

}  // namespace duo
