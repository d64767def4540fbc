// Frames on the CPU, one after the other: what the simd engine's threads do.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/clock.h"
#include "core/concurrency_throttle.h"
#include "core/pool.h"
#include "engines/filling.h"
#include "engines/focused.h"
#include "engines/prepared.h"
#include "stages/diffusion/diffusion.h"

namespace duo {

/// Makes a frame of a pair with a pool of threads and scratch memory of its own; allocates nothing once it is
/// there, but for the first focus (see Focused).
///
/// Threads  one caller at a time; the pool's work for it
class SimdFrames {
 public:
  /// `prepared` must outlive this.
  SimdFrames(const Prepared& prepared, int threads);
  SimdFrames(const SimdFrames&) = delete;
  SimdFrames& operator=(const SimdFrames&) = delete;

  /// `frame` comes from make_frame(). Windows: see Engine::look_at(), focus: Engine::focus().
  /// `turn`: which pair of the stream, from 0.
  void make(const Pair& pair, std::span<const Window> windows, const Focus& focus, std::uint64_t turn, Frame& frame);

 private:
  void prepare_view(const Picture& picture, const ResampleMap* map, Image<std::uint8_t>& out, Image<std::uint8_t>& inside);
  void prepare_color(const Picture& picture, const ResampleMap* map, Image<Rgb8>& out);

  const Prepared& prepared_;
  Pool pool_;
  ConcurrencyThrottle throttle_;
  Matchers::Simd matcher_;
  Focused<Matchers::Simd> focused_;
  std::optional<Filling> filling_;
  std::optional<simd::DiffusionScratch> diffusion_;
  Image<Rgb8> left_color_, right_color_;  // of matchers that take colours; the left one where the frame has none
  Image<std::uint16_t> filled_;           // and what those that know say of holes
  Image<std::uint8_t> now_, next_;        // one view on its way through the denoising
  StageTimer timer_;
};

}  // namespace duo
