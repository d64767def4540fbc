#include "pipeline/black_bars.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

namespace duo {
namespace {

/// A pair of bars: how thick that at the lower coordinates is, and the other.
struct Bars {
  int before, after;
};

/// Across the rows of a picture, or its columns.
class Lines {
 public:
  Lines(View<const Rgb8> picture, bool of_rows) : picture_(picture), of_rows_(of_rows) {}
  int count() const { return of_rows_ ? picture_.height() : picture_.width(); }
  bool is_black(int line) const { return bright(line, kBlack) == 0; }
  /// Whether there is a picture: not some pixels of a border that is not straight.
  bool shows_much(int line) const { return bright(line, kShows) * kShare > length(); }
  bool is_dark() const {
    for (int line = 0; line < count(); ++line)
      if (shows_much(line)) return false;
    return true;
  }

 private:
  static constexpr int kBlack = 28, kShows = 40, kShare = 4;  // levels; video has black at 16, and codes it with errors
  int length() const { return of_rows_ ? picture_.width() : picture_.height(); }
  int bright(int line, int level) const {
    int found = 0;
    for (int i = 0; i < length(); ++i) {
      const Rgb8 p = of_rows_ ? picture_.row(line)[i] : picture_.row(i)[line];
      found += std::max({p.r, p.g, p.b}) > level;
    }
    return found;
  }

  View<const Rgb8> picture_;
  bool of_rows_;
};

std::optional<Bars> bars_of(const Lines& lines) {
  constexpr int kThin = 32, kBlurred = 2, kUneven = 2;  // of the picture; lines
  const int count = lines.count();
  Bars bars{0, 0};
  while (bars.before < count / 2 && lines.is_black(bars.before)) ++bars.before;
  while (bars.after < count / 2 && lines.is_black(count - 1 - bars.after)) ++bars.after;
  if (bars.before * kThin < count || bars.before >= count / 2 - kBlurred) return {};
  if (std::abs(bars.before - bars.after) > kUneven) return {};
  if (!lines.shows_much(bars.before + kBlurred) || !lines.shows_much(count - 1 - bars.after - kBlurred)) return {};
  return bars;
}

}  // namespace

std::optional<std::string> black_bars(const Pair& pair) {
  constexpr int kApart = 2;  // lines
  for (const Picture* picture : {&pair.left, &pair.right})
    if (Lines(picture->pixels.view(), true).is_dark()) return {};
  const auto even = [](int lines) { return (lines + 1) / 2 * 2; };  // as coded colours need it
  const auto [width, height] = pair.left.pixels.size();
  for (const bool of_rows : {true, false}) {
    const auto left = bars_of({pair.left.pixels.view(), of_rows}), right = bars_of({pair.right.pixels.view(), of_rows});
    if (!left || !right || std::abs(left->before - right->before) > kApart) continue;
    const int bar = std::max(left->before, right->before), before = even(bar),
              both = before + even(std::max(left->after, right->after));
    return fmt::format(
        "both pictures have black bars of {} px {}: depth is made up there; cut them off, and calibrate without them, as with "
        "ffmpeg -vf crop={}:{}:{}:{}",
        bar, of_rows ? "at the top and the bottom" : "at both sides", of_rows ? width : width - both,
        of_rows ? height - both : height, of_rows ? 0 : before, of_rows ? before : 0);
  }
  return "";
}

}  // namespace duo
