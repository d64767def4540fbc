// The reference engine: plain loops, one thread. Slow on purpose: it defines the right answer.

#include <algorithm>
#include <utility>
#include <variant>

#include "core/check.h"
#include "core/clock.h"
#include "core/object_pool.h"
#include "engines/engines.h"
#include "engines/focused.h"
#include "engines/keep_windows.h"
#include "engines/prepared.h"
#include "stages/depth/depth.h"
#include "stages/diffusion/diffusion.h"
#include "stages/fill/fill.h"
#include "stages/fill_regions/fill_regions.h"
#include "stages/gaussian/gaussian.h"
#include "stages/gray/gray.h"
#include "stages/median/median.h"
#include "stages/rectify/rectify.h"

namespace duo {
namespace {

class RefEngine final : public Engine {
 public:
  const char* name() const override { return "ref"; }
  const std::optional<Rectified>& rectified() const override { return prepared_.geometry; }

  Result<void> prepare(const Setup& setup) override {
    DUO_TRY_ASSIGN(prepared_, prepare_setup(setup));
    frames_ = ObjectPool<Frame>(1 + kSpareFrames, [this] { return make_frame(prepared_); });
    Matchers::make(prepared_.matcher, match_setup(prepared_), matcher_);
    focused_ = {};
    focus_ = {};
    if (setup.fill) {
      unfilled_ = Image<std::uint16_t>(prepared_.size);
    }
    left_color_ = Image<Rgb8>(prepared_.match_color && !prepared_.color ? prepared_.size : Size{});
    right_color_ = Image<Rgb8>(prepared_.match_color ? prepared_.size : Size{});
    filled_ = Image<std::uint16_t>(prepared_.match_fill ? prepared_.size : Size{});
    now_ = Image<std::uint8_t>(setup.size);
    next_ = Image<std::uint8_t>(setup.size);
    return {};
  }

  void look_at(std::span<const Window> windows) override { windows_.assign(windows.begin(), windows.end()); }
  void focus(const Focus& focus) override { focus_ = focus; }
  bool can_focus() const override { return !prepared_.match_color; }

  void submit(const Pair& pair) override {
    DUO_CHECK(matcher_.has_value());
    DUO_CHECK(pair.left.pixels.size() == prepared_.setup.size && pair.right.pixels.size() == prepared_.setup.size);
    const Setup& setup = prepared_.setup;
    current_ = frames_.lend();
    Frame& frame = *current_;
    frame.sequence = pair.sequence;
    frame.t_ns = pair.left.t_ns;
    frame.skew_ns = pair.right.t_ns - pair.left.t_ns;
    timer_.start(frame.stages, setup.time_stages);

    const auto* maps = prepared_.rectification ? &*prepared_.rectification : nullptr;
    prepare_view(pair.left, maps ? &maps->left : nullptr, frame.left, frame.left_inside);
    prepare_view(pair.right, maps ? &maps->right : nullptr, frame.right, frame.right_inside);

    Disparity& disparity = frame.disparity;
    GrayPair gray{frame.left, frame.right, frame.left_inside, frame.right_inside};
    gray.coding_noise_q4 = coding_noise_q4(prepared_, pair);
    if (prepared_.color) prepare_color(pair.left, maps != nullptr ? &maps->left : nullptr, frame.color);
    timer_.stage("color");
    if (prepared_.match_color) {
      if (!prepared_.color) prepare_color(pair.left, maps != nullptr ? &maps->left : nullptr, left_color_);
      prepare_color(pair.right, maps != nullptr ? &maps->right : nullptr, right_color_);
      gray.left_color = prepared_.color ? frame.color : left_color_;
      gray.right_color = right_color_;
    }
    const bool whole = !can_focus() || focus_.window.within(prepared_.size).empty();
    frame.matched = {};
    if (whole)
      std::visit([&](auto& matcher) { matcher.match(gray, {disparity.d_q4, frame.confidence, filled_}, timer_); }, *matcher_);
    else
      focused_.match(
          prepared_, focus_, gray, matcher_,
          [&](const MatchSetup& of_part, Matchers::Ref& out) { Matchers::make(prepared_.matcher, of_part, out); }, timer_,
          frame);
    ref::mark_measured(disparity.d_q4, disparity.origin);
    if (prepared_.match_fill) take_filled(filled_, disparity.d_q4, disparity.origin);
    if (setup.fill && whole) fill(frame);
    if (whole) keep_windows(windows_, frame);
    timer_.stage("fill");
    if (setup.wants.depth) ref::depth(disparity.d_q4, focal_baseline_px_mm(*prepared_.geometry), frame.depth_mm);
    timer_.stage("depth");
  }

  std::shared_ptr<const Frame> collect() override { return std::exchange(current_, nullptr); }

 private:
  /// Raw colour to what the matcher sees. Denoising comes before resampling: only there is noise independent from pixel to
  /// pixel.
  void prepare_view(const Picture& picture, const ResampleMap* map, Image<std::uint8_t>& out, Image<std::uint8_t>& inside) {
    ref::gray(picture.pixels, now_);
    timer_.stage("gray");
    if (prepared_.median) {
      ref::median3x3(now_, next_);
      now_.swap(next_);
      timer_.stage("median");
    }
    if (prepared_.gaussian) {
      ref::gaussian5x5(now_, next_);
      now_.swap(next_);
      timer_.stage("gaussian");
    }
    if (prepared_.diffusion) {
      ref::diffuse(now_, now_);
      timer_.stage("diffusion");
    }
    if (map != nullptr)
      ref::rectify(now_, *map, out, inside);
    else
      out.swap(now_);
    timer_.stage("rectify");
  }

  void fill(Frame& frame) {
    Disparity& disparity = frame.disparity;
    const int max_disparity = prepared_.setup.max_disparity;
    ref::fill_regions({frame.left, max_disparity}, disparity.d_q4, disparity.origin);
    disparity.d_q4.swap(unfilled_);
    ref::fill(unfilled_, max_disparity, disparity.origin, disparity.d_q4);
  }

  void prepare_color(const Picture& picture, const ResampleMap* map, Image<Rgb8>& out) {
    if (map != nullptr) return simd::rectify(pool_, picture.pixels, *map, out);
    for (int y = 0; y < picture.pixels.height(); ++y) std::copy_n(picture.pixels.row(y), picture.pixels.width(), out.row(y));
  }

  Pool pool_{1};  // colour for display is resampled by the same code in every engine
  Prepared prepared_;
  Matchers::Ref matcher_;
  std::vector<Window> windows_;
  Focus focus_;
  Focused<Matchers::Ref> focused_;
  ObjectPool<Frame> frames_;
  std::shared_ptr<Frame> current_;  // until it is collected
  Image<std::uint16_t> unfilled_;
  Image<Rgb8> left_color_, right_color_;  // of matchers that take colours; the left one where the frame has none
  Image<std::uint16_t> filled_;           // and what those that know say of holes
  Image<std::uint8_t> now_, next_;        // one view on its way through the denoising
  StageTimer timer_;
};

}  // namespace

std::unique_ptr<Engine> make_ref_engine() { return std::make_unique<RefEngine>(); }

}  // namespace duo
