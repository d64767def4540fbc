#include "engines/focused.h"

#include <algorithm>

#include "core/check.h"

namespace duo {
namespace {

constexpr int kStep_q4 = 16;        // of one px of disparity
constexpr int kDisparityStep = 64;  // what the matchers' vectors take at once
constexpr int kColumnStep = 32;     // likewise of columns

/// `length` up to a multiple of `step`, `whole` at most.
int rounded_up(int length, int step, int whole) { return std::min((length + step - 1) / step * step, whole); }

template <class T>
View<T> cut(View<T> map, const Window& window, int shift = 0) {
  return map.empty() ? map : map.crop(window.y, window.x - shift, {window.width, window.height});
}

}  // namespace

FocusPart focus_part(const Focus& focus, Size size, int max_disparity, bool few_sizes) {
  FocusPart out;
  const Window& kept = out.kept = focus.window.within(size);
  DUO_CHECK(!kept.empty());
  Window& matched = out.matched;
  matched.width = rounded_up(kept.width, few_sizes ? std::max(size.width / 8, 1) : kColumnStep, size.width);
  matched.height = few_sizes ? rounded_up(kept.height, std::max(size.height / 4, 1), size.height) : kept.height;
  matched.x = std::max(kept.x_end() - matched.width, 0);
  matched.y = std::min(kept.y, size.height - matched.height);
  const int first = std::clamp(focus.disparity_begin, 0, std::min(matched.x, max_disparity - 1));
  const int end = std::clamp(focus.disparity_end, first + 1, max_disparity);
  out.disparities = rounded_up(end - first, kDisparityStep, max_disparity);
  // What more is searched lies behind: without a disparity of its own the background beside a person takes the person's.
  out.row_step = std::max(focus.row_step, 1);
  out.first_disparity = std::max(end - out.disparities, 0);
  return out;
}

GrayPair part_of(const GrayPair& whole, View<const std::uint8_t> balanced, const FocusPart& part) {
  const Window& window = part.matched;
  const int shift = part.first_disparity;
  return {cut(whole.left, window), cut(balanced, window, shift), cut(whole.left_inside, window),
          cut(whole.right_inside, window, shift)};
}

Match part_of(Frame& frame, const FocusPart& part) {
  return {cut(frame.disparity.d_q4.view(), part.matched), cut(frame.confidence.view(), part.matched)};
}

void keep_part(const FocusPart& part, Frame& frame) {
  const Window& kept = part.kept;
  const auto added = static_cast<std::uint16_t>(part.first_disparity * kStep_q4);
  const auto clear = [&](auto* row, auto nothing) {
    std::fill(row, row + kept.x, nothing);
    std::fill(row + kept.x_end(), row + frame.disparity.d_q4.width(), nothing);
  };
  frame.matched = kept == Window::all(frame.disparity.d_q4.size()) ? Window{} : kept;
  for (int y = 0; y < frame.disparity.d_q4.height(); ++y) {
    std::uint16_t* const d = frame.disparity.d_q4.row(y);
    if (y < kept.y || y >= kept.y_end()) {
      std::fill_n(d, frame.disparity.d_q4.width(), Disparity::kNone);
      if (!frame.confidence.empty()) std::fill_n(frame.confidence.row(y), frame.confidence.width(), std::uint8_t{0});
      continue;
    }
    clear(d, Disparity::kNone);
    if (!frame.confidence.empty()) clear(frame.confidence.row(y), std::uint8_t{0});
    if (added == 0) continue;
    for (int x = kept.x; x < kept.x_end(); ++x)
      if (d[x] != Disparity::kNone) d[x] = static_cast<std::uint16_t>(d[x] + added);
  }
}

}  // namespace duo
