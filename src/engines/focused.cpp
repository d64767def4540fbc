#include "engines/focused.h"

#include <algorithm>

#include "core/check.h"

namespace duo {
namespace {

constexpr int kStep_q4 = 16;        // of one px of disparity
constexpr int kDisparityStep = 64;  // what the matchers' vectors take at once

/// `length` up to a multiple of `step`, `whole` at most.
int rounded_up(int length, int step, int whole) { return std::min((length + step - 1) / step * step, whole); }

}  // namespace

FocusPart focus_part(const Focus& focus, Size size, int max_disparity) {
  FocusPart out;
  out.kept = focus.window.within(size);
  DUO_CHECK(!out.kept.empty());
  const int first = std::clamp(focus.disparity_begin, 0, max_disparity - 1);
  const int end = std::clamp(focus.disparity_end, first + 1, max_disparity);
  out.disparities = rounded_up(end - first, kDisparityStep, max_disparity);
  // What more is searched lies behind: without a disparity of its own the background beside a person takes the person's.
  out.first_disparity = std::max(end - out.disparities, 0);
  Window& matched = out.matched;
  matched.width = rounded_up(out.kept.width, std::max(size.width / 8, 1), size.width);
  matched.height = rounded_up(out.kept.height, std::max(size.height / 4, 1), size.height);
  matched.x = std::max(out.kept.x_end() - matched.width, 0);
  matched.y = std::min(out.kept.y, size.height - matched.height);
  return out;
}

FocusMaps::FocusMaps(Size size, bool confidence_too)
    : left(size), right(size), left_inside(size), right_inside(size), d_q4(size) {
  if (confidence_too) confidence = Image<std::uint8_t>(size);
}

void FocusMaps::cut(const FocusPart& part, const Frame& frame, View<const std::uint8_t> balanced) {
  const Window& window = part.matched;
  const int outside = std::clamp(part.first_disparity - window.x, 0, window.width);  // columns
  for (int y = 0; y < window.height; ++y) {
    const int from = window.y + y, first = window.x + outside - part.first_disparity;
    const auto copy = [&](View<const std::uint8_t> all, int x, int to, Image<std::uint8_t>& out) {
      if (all.empty())
        std::fill(out.row(y) + to, out.row(y) + window.width, std::uint8_t{255});
      else
        std::copy_n(all.row(from) + x, window.width - to, out.row(y) + to);
    };
    copy(frame.left, window.x, 0, left);
    copy(frame.left_inside, window.x, 0, left_inside);
    copy(balanced, first, outside, right);
    copy(frame.right_inside, first, outside, right_inside);
    std::fill_n(right.row(y), outside, balanced.at(from, 0));
    std::fill_n(right_inside.row(y), outside, std::uint8_t{0});
  }
}

void FocusMaps::put(const FocusPart& part, Frame& frame) const {
  const Window &kept = part.kept, &matched = part.matched;
  const auto added = static_cast<std::uint16_t>(part.first_disparity * kStep_q4);
  frame.matched = kept == Window::all(frame.disparity.d_q4.size()) ? Window{} : kept;
  for (int y = 0; y < frame.disparity.d_q4.height(); ++y) {
    std::uint16_t* const d = frame.disparity.d_q4.row(y);
    std::fill_n(d, frame.disparity.d_q4.width(), Disparity::kNone);
    if (!frame.confidence.empty()) std::fill_n(frame.confidence.row(y), frame.confidence.width(), std::uint8_t{0});
    if (y < kept.y || y >= kept.y_end()) continue;
    const std::uint16_t* const found = d_q4.row(y - matched.y) - matched.x;
    for (int x = kept.x; x < kept.x_end(); ++x)
      if (found[x] != Disparity::kNone) d[x] = static_cast<std::uint16_t>(found[x] + added);
    if (!frame.confidence.empty())
      std::copy_n(confidence.row(y - matched.y) + kept.x - matched.x, kept.width, frame.confidence.row(y) + kept.x);
  }
}

}  // namespace duo
