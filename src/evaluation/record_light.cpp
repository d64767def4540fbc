#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "core/clock.h"
#include "duoptic/interrupt.h"
#include "duoptic/statistics.h"
#include "duoptic/structured_light.h"

namespace duo {
namespace {

/// Both views, green, as means of blocks: what is left of the noise is small.
using Blocks = std::vector<float>;

void append_blocks(const Image<Rgb8>& picture, Blocks& to) {
  constexpr int kSide = 4;
  for (int y = 0; y + kSide <= picture.height(); y += kSide)
    for (int x = 0; x + kSide <= picture.width(); x += kSide) {
      int sum = 0;
      for (int v = y; v < y + kSide; ++v)
        for (int u = x; u < x + kSide; ++u) sum += picture.at(v, u).g;
      to.push_back(static_cast<float>(sum) / (kSide * kSide));
    }
}

Blocks blocks_of(const Pair& pair) {
  Blocks out;
  append_blocks(pair.left.pixels, out);
  append_blocks(pair.right.pixels, out);
  return out;
}

/// Levels by which the hundredth of the blocks that differs the most does: the projector may light a small part alone.
float difference(const Blocks& a, const Blocks& b) {
  if (a.size() != b.size() || a.empty()) return 255;
  std::vector<float> all(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) all[i] = std::abs(a[i] - b[i]);
  return quantile(all, 0.99);
}

/// Adds up pictures and gives their mean.
class MeanPair {
 public:
  void clear() { count_ = 0; }
  int count() const { return count_; }
  void add(const Pair& pair) {
    add(pair.left.pixels, left_);
    add(pair.right.pixels, right_);
    ++count_;
  }
  Pair mean(Size size) const {
    Pair out;
    out.left.pixels = mean(left_, size);
    out.right.pixels = mean(right_, size);
    return out;
  }

 private:
  void add(const Image<Rgb8>& picture, std::vector<std::uint32_t>& sums) const {
    sums.resize(std::size_t{3} * picture.width() * picture.height());
    if (count_ == 0) std::fill(sums.begin(), sums.end(), 0);
    auto at = sums.begin();
    for (int y = 0; y < picture.height(); ++y)
      for (int x = 0; x < picture.width(); ++x) {
        const Rgb8 c = picture.at(y, x);
        *at++ += c.r, *at++ += c.g, *at++ += c.b;
      }
  }
  Image<Rgb8> mean(const std::vector<std::uint32_t>& sums, Size size) const {
    Image<Rgb8> out(size);
    auto at = sums.begin();
    const auto next = [&] { return static_cast<std::uint8_t>((*at++ + static_cast<std::uint32_t>(count_) / 2) / count_); };
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        Rgb8& c = out.at(y, x);
        c.r = next(), c.g = next(), c.b = next();
      }
    return out;
  }

  std::vector<std::uint32_t> left_, right_;
  int count_ = 0;
};

class Recording {
 public:
  Recording(PairSource& pairs, const LightRecording& how, LightScreen& screen) : pairs_(pairs), how_(how), screen_(screen) {}

  /// Shows gray until cameras have locked their exposure, and measures how much pictures differ meanwhile, at its end.
  Result<void> warm_up(Size screen) {
    Image<std::uint8_t> gray(screen);
    for (int y = 0; y < screen.height; ++y) std::fill_n(gray.row(y), screen.width, static_cast<std::uint8_t>(how_.white / 2));
    DUO_TRY(show(gray));
    constexpr std::size_t kStill = 8;
    std::vector<float> differences;
    const TimeNs until = wall_ns() + seconds(how_.warm_up_s), latest = until + seconds(how_.most_s);
    while (wall_ns() < until || differences.size() < kStill) {
      if (wall_ns() > latest) return refused("no pictures come; is a camera away?");
      DUO_TRY_ASSIGN(const bool any, next());
      if (any && !before_.empty()) differences.push_back(difference(now_, before_));
      if (any) before_ = now_;
    }
    std::vector<float> last(differences.end() - kStill, differences.end());
    constexpr float kLeast = 0.5f;
    still_ = std::max(1.5f * quantile(last, 1), kLeast);
    return {};
  }

  /// Shows a pattern and returns the mean of its pictures.
  Result<Pair> record(View<const std::uint8_t> picture, const std::string& name) {
    const Blocks other = before_;
    DUO_TRY(show(picture));
    const TimeNs latest = wall_ns() + seconds(how_.most_s);
    bool changed = false;
    MeanPair mean;
    while (mean.count() < how_.average) {
      if (wall_ns() > latest)
        return refused(
            changed ? fmt::format("the pictures of {} do not come to rest within {:g} s; does something move, or a lamp "
                                  "flicker?",
                                  name, how_.most_s)
                    : fmt::format("{} is not seen within {:g} s; do both cameras see what the projector lights, and is it "
                                  "bright enough?",
                                  name, how_.most_s));
      DUO_TRY_ASSIGN(const bool any, next());
      if (!any) continue;
      changed = changed || difference(now_, other) > 2 * still_;
      const bool still = difference(now_, before_) <= still_;
      before_ = now_;
      if (!changed || !still) {
        mean.clear();
        continue;
      }
      mean.add(pair_);
    }
    return mean.mean(pair_.left.pixels.size());
  }

 private:
  static TimeNs seconds(double s) { return std::llround(s * 1e9); }
  static Error refused(const std::string& why) { return {ErrorCode::kBadInput, "cannot record patterns: " + why}; }

  Result<void> show(View<const std::uint8_t> picture) {
    DUO_TRY_ASSIGN(const bool shown, screen_.show(picture));
    if (!shown || Interrupt::asked()) return refused("ended before all were recorded; nothing was written");
    shown_ns_ = wall_ns();
    return {};
  }

  /// The next pair that was taken since the pattern was shown; false when none came.
  Result<bool> next() {
    if (Interrupt::asked()) return refused("ended before all were recorded; nothing was written");
    DUO_TRY_ASSIGN(const Next next, pairs_.next(pair_));
    if (next == Next::kEnd || next == Next::kCut) return refused("the cameras gave no more pictures");
    if (next != Next::kNew || std::min(pair_.left.t_ns, pair_.right.t_ns) < shown_ns_) return false;
    now_ = blocks_of(pair_);
    return true;
  }

  PairSource& pairs_;
  const LightRecording& how_;
  LightScreen& screen_;
  Pair pair_;
  Blocks now_, before_;
  float still_ = 0;
  TimeNs shown_ns_ = 0;
};

}  // namespace

Result<void> record_light(PairSource& pairs, const LightCode& code, const LightRecording& how, LightScreen& screen,
                          const std::function<Result<void>(std::size_t pattern, const Pair& pair)>& keep) {
  DUO_TRY(check_light_code(code));
  if (!pairs.live())
    return Error{ErrorCode::kBadInput, "cannot record patterns: files and pictures do not see the screen; give two cameras"};
  Recording recording(pairs, how, screen);
  DUO_TRY(recording.warm_up(code.screen));
  const std::vector<LightPattern> patterns = light_patterns(code);
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    const std::string name = fmt::format("pattern {} of {} ({})", i, patterns.size(), describe_pattern(code, patterns[i]));
    DUO_TRY_ASSIGN(const Pair pair, recording.record(draw_pattern(code, patterns[i], how.white), name));
    DUO_TRY(keep(i, pair));
  }
  return {};
}

}  // namespace duo
