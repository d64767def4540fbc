#include "pipeline/repeat_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace duo {
namespace {

constexpr int kGrid_px = 8;
constexpr const char* kSides[] = {"left", "right"};

enum class Change : std::uint8_t { kNone, kLittle, kMotion };
constexpr int kStep = 16;            // levels: above the noise of cameras and of coding
constexpr std::size_t kShare = 200;  // one of so many pixels: an arm, a head

void take_grid(View<const Rgb8> picture, std::vector<std::uint8_t>& into) {
  into.clear();
  for (int y = kGrid_px / 2; y < picture.height(); y += kGrid_px)
    for (int x = kGrid_px / 2; x < picture.width(); x += kGrid_px) into.push_back(picture.row(y)[x].g);
}

Change change_of(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& now) {
  constexpr std::size_t kStill = 8 * kShare;
  constexpr std::size_t kQuiet = 4;  // a quarter of a level in the mean, by coding anew; cameras' noise is more
  if (before.size() != now.size()) return Change::kLittle;  // the first
  std::size_t steps = 0, sum = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const int by = std::abs(now[i] - before[i]);
    sum += static_cast<std::size_t>(by);
    steps += by > kStep;
  }
  if (sum * kQuiet <= now.size() && steps * kStill <= now.size()) return Change::kNone;
  return steps * kShare >= now.size() ? Change::kMotion : Change::kLittle;
}

double motion_between(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& now) {
  int sum = 0;
  for (std::size_t i = 0; i < std::min(before.size(), now.size()); ++i)
    if (const int by = std::abs(now[i] - before[i]); by > kStep) sum += by;
  return sum;
}

/// A covered lens, a picture without light: it looks the same however it was taken.
bool is_flat(const std::vector<std::uint8_t>& grid) {
  constexpr int kFlat = 16;  // levels
  if (grid.empty()) return true;
  const auto [least, most] = std::minmax_element(grid.begin(), grid.end());
  return *most - *least <= kFlat;
}

}  // namespace

void RepeatWatch::see(const Pair& pair) {
  std::array<Change, 2> changes{};
  for (std::size_t i = 0; i < 2; ++i) {
    take_grid((i == 0 ? pair.left : pair.right).pixels.view(), now_);
    changes[i] = is_flat(now_) ? Change::kLittle : change_of(sides_[i].before, now_);
    motion_[i] = motion_between(sides_[i].before, now_);
    std::swap(sides_[i].before, now_);
  }
  moved_ += changes[0] == Change::kMotion || changes[1] == Change::kMotion;
  for (std::size_t i = 0; i < 2; ++i) {
    Side& side = sides_[i];
    if (changes[i] != Change::kNone) {
      side.in_a_row = 0;
    } else if (changes[1 - i] == Change::kMotion) {
      ++side.repeated;
      side.most_in_a_row = std::max(side.most_in_a_row, ++side.in_a_row);
    }
  }
}

double RepeatWatch::least_motion() const {
  return kStep * static_cast<double>(sides_[0].before.size()) / static_cast<double>(kShare);
}

std::string RepeatWatch::warning(bool live) const {
  constexpr int kHangs = 10, kFewest = 5;  // pictures
  constexpr double kOften = 0.1;           // of the pairs with motion
  for (std::size_t i = 0; i < 2; ++i) {
    const Side& side = sides_[i];
    if (live && side.in_a_row >= kHangs)
      return fmt::format(
          "the {} camera's pictures stay the same while the {} one's move: it hangs, and depth of what moves is wrong, or it "
          "sees nothing of what moves",
          kSides[i], kSides[1 - i]);
    if (!live && side.repeated >= std::max<double>(kFewest, kOften * moved_))
      return fmt::format(
          "{} of the {} pictures are the same as the one before, up to {} in a row, while the {} ones move: its camera was "
          "slower or hung, and depth of what moves is wrong there, or it saw nothing of what moves",
          side.repeated, kSides[i], side.most_in_a_row, kSides[1 - i]);
  }
  return {};
}

}  // namespace duo
