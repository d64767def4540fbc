// A frame on the CPU: Highway stages on a pool of threads.

#include "engines/simd_frames.h"

#include <algorithm>

#include "core/check.h"
#include "engines/keep_windows.h"
#include "stages/depth/depth.h"
#include "stages/diffusion/diffusion.h"
#include "stages/fill/fill.h"
#include "stages/gaussian/gaussian.h"
#include "stages/gray/gray.h"
#include "stages/median/median.h"
#include "stages/rectify/rectify.h"

namespace duo {

SimdFrames::SimdFrames(const Prepared& prepared, int threads) : prepared_(prepared), pool_(threads), throttle_(pool_.most()) {
  Matchers::make(pool_, prepared.matcher, match_setup(prepared), matcher_);
  if (prepared.setup.fill) filling_.emplace(prepared.size, prepared.setup.max_disparity);
  if (prepared.diffusion) diffusion_.emplace(prepared.setup.size);
  if (prepared.match_color && !prepared.color) left_color_ = Image<Rgb8>(prepared.size);
  if (prepared.match_color) right_color_ = Image<Rgb8>(prepared.size);
  if (prepared.match_fill) filled_ = Image<std::uint16_t>(prepared.size);
  now_ = Image<std::uint8_t>(prepared.setup.size);
  next_ = Image<std::uint8_t>(prepared.setup.size);
}

void SimdFrames::make(const Pair& pair, std::span<const Window> windows, const Focus& focus, std::uint64_t turn, Frame& frame) {
  DUO_CHECK(pair.left.pixels.size() == prepared_.setup.size && pair.right.pixels.size() == prepared_.setup.size);
  const Setup& setup = prepared_.setup;
  pool_.use(throttle_.threads());
  frame.sequence = pair.sequence;
  frame.t_ns = pair.left.t_ns;
  frame.skew_ns = pair.right.t_ns - pair.left.t_ns;
  timer_.start(frame.stages, setup.time_stages);

  const auto* maps = prepared_.rectification ? &*prepared_.rectification : nullptr;
  prepare_view(pair.left, maps ? &maps->left : nullptr, frame.left, frame.left_inside);
  // While the picture and its map are in the cache.
  if (prepared_.color) prepare_color(pair.left, maps != nullptr ? &maps->left : nullptr, frame.color);
  timer_.stage("color");
  prepare_view(pair.right, maps ? &maps->right : nullptr, frame.right, frame.right_inside);

  Disparity& disparity = frame.disparity;
  const bool whole = prepared_.match_color || focus.window.within(prepared_.size).empty();
  GrayPair gray{frame.left, frame.right, frame.left_inside, frame.right_inside, turn};
  gray.coding_noise_q4 = coding_noise_q4(prepared_, pair);
  if (whole) {
    frame.matched = {};
    // What fills a hole may come from anywhere in the picture.
    const RowBand matched = setup.fill ? RowBand{} : RowBand::of(windows, prepared_.size);
    if (prepared_.match_color) {
      if (!prepared_.color) prepare_color(pair.left, maps != nullptr ? &maps->left : nullptr, left_color_);
      prepare_color(pair.right, maps != nullptr ? &maps->right : nullptr, right_color_);
      gray.left_color = prepared_.color ? frame.color : left_color_;
      gray.right_color = right_color_;
    }
    const Match found{disparity.d_q4, frame.confidence, filled_};
    std::visit([&](auto& matcher) { matcher.match(gray, found, timer_, matched); }, *matcher_);
  } else {
    focused_.match(
        prepared_, focus, gray, matcher_,
        [&](const MatchSetup& of_part, Matchers::Simd& out) {
          pool_.use(pool_.most());  // it has memory for as many
          Matchers::make(pool_, prepared_.matcher, of_part, out);
          pool_.use(throttle_.threads());
        },
        timer_, frame);
  }
  simd::mark_measured(pool_, disparity.d_q4, disparity.origin);
  if (prepared_.match_fill) take_filled(filled_, disparity.d_q4, disparity.origin);
  if (filling_ && whole) filling_->fill(pool_, frame.left, disparity);
  if (whole) keep_windows(windows, frame);
  timer_.stage("fill");
  if (setup.wants.depth) simd::depth(pool_, disparity.d_q4, focal_baseline_px_mm(*prepared_.geometry), frame.depth_mm);
  timer_.stage("depth");
  const Pool::Effort effort = pool_.take_effort();
  throttle_.made(effort.wall_ns, effort.cpu_ns);
}

/// Raw colour to what the matcher sees. Denoising comes before resampling: only there is noise independent from pixel to
/// pixel.
void SimdFrames::prepare_view(const Picture& picture, const ResampleMap* map, Image<std::uint8_t>& out,
                              Image<std::uint8_t>& inside) {
  simd::gray(pool_, picture.pixels, now_);
  timer_.stage("gray");
  if (prepared_.median) {
    simd::median3x3(pool_, now_, next_);
    now_.swap(next_);
    timer_.stage("median");
  }
  if (prepared_.gaussian) {
    simd::gaussian5x5(pool_, now_, next_);
    now_.swap(next_);
    timer_.stage("gaussian");
  }
  if (prepared_.diffusion) {
    simd::diffuse(pool_, now_, *diffusion_, now_);
    timer_.stage("diffusion");
  }
  if (map != nullptr)
    simd::rectify(pool_, now_, *map, out, inside);
  else
    out.swap(now_);
  timer_.stage("rectify");
}

void SimdFrames::prepare_color(const Picture& picture, const ResampleMap* map, Image<Rgb8>& out) {
  if (map != nullptr) return simd::rectify(pool_, picture.pixels, *map, out);
  for (int y = 0; y < picture.pixels.height(); ++y) std::copy_n(picture.pixels.row(y), picture.pixels.width(), out.row(y));
}

}  // namespace duo
