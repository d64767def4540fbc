#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "calib/rectification.h"
#include "core/check.h"
#include "duoptic/structured_light.h"
#include "evaluation/light_code.h"

namespace duo {
namespace {

Image<Rgb8> rectified_picture(Pool& pool, const Image<Rgb8>& raw, const ResampleMap* map) {
  if (map == nullptr) return raw.clone();
  Image<Rgb8> out(map->corner.size());
  simd::rectify(pool, raw, *map, out);
  return out;
}

LightCounts count_states(View<const std::uint8_t> states) {
  std::array<std::int64_t, 5> counts{};  // by LightState
  for (int y = 0; y < states.height(); ++y)
    for (int x = 0; x < states.width(); ++x) ++counts[states.at(y, x)];
  const auto of = [&](LightState state) { return counts[static_cast<std::size_t>(state)]; };
  LightCounts out{0, of(LightState::kKnown), of(LightState::kSaturated), of(LightState::kUnlit), of(LightState::kUncertain)};
  out.pixels = out.known + out.saturated + out.unlit + out.uncertain;
  return out;
}

double percent_of(std::int64_t part, std::int64_t all) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::int64_t>(all, 1));
}

}  // namespace

struct LightDecoder::State {
  /// What all exposures so far tell of one view.
  struct LitView {
    ViewPlaces places;
    Image<std::uint8_t> state;     // LightState
    Image<std::uint16_t> clarity;  // amplitude of the sine in 1/16 of the noise; of the exposure whose places are kept
    std::vector<Image<std::uint16_t>> samples;  // of the exposure that comes in, by pattern

    explicit LitView(Size size) : places{Image<std::int32_t>(size), Image<std::int32_t>(size)}, state(size), clarity(size) {
      for (int y = 0; y < size.height; ++y) {
        std::fill_n(places.x_q8.row(y), size.width, -1);
        std::fill_n(places.y_q8.row(y), size.width, -1);
      }
    }
  };

  LightCode code;
  Size raw;
  std::optional<Rectification> maps;
  mutable Pool pool;
  std::array<int, 2> bits;  // of columns and rows
  std::size_t patterns, next = 0;
  int exposures = 0;
  Pair light;  // raw, of the first pattern of the first exposure
  LitView left, right;

  State(const LightCode& shown, Size raw_size, std::optional<Rectification> rectification, int threads)
      : code(shown),
        raw(raw_size),
        maps(std::move(rectification)),
        pool(threads),
        bits{gray_bits(shown, false), gray_bits(shown, true)},
        patterns(light_patterns(shown).size()),
        left(raw_size),
        right(raw_size) {}

  const ResampleMap* map(bool is_left) const { return !maps ? nullptr : is_left ? &maps->left : &maps->right; }

  static Image<std::uint16_t> brightness(const Image<Rgb8>& picture) {
    Image<std::uint16_t> out(picture.size());
    for (int y = 0; y < out.height(); ++y)
      for (int x = 0; x < out.width(); ++x) out.at(y, x) = brightness_of(picture.at(y, x));
    return out;
  }

  PlacePlanes seen(const LitView& view, const ResampleMap* map) const { return place_planes(pool, view.places, map, code); }

  /// Places, by axis, of a pixel's samples: those of the light come first, then of columns, then of rows.
  template <class F>
  void each_axis(const LitView& view, int y, int x, F&& f) const {
    constexpr std::size_t kMostSamples = 2 * 16 + kPhaseSteps;
    std::array<std::uint16_t, kMostSamples> samples;
    std::size_t at = 1;
    for (const bool rows : {false, true}) {
      const auto count = static_cast<std::size_t>(2 * bits[rows] + kPhaseSteps);
      for (std::size_t i = 0; i < count; ++i) samples[i] = view.samples[at + i].at(y, x);
      at += count;
      f(rows, std::span(samples.data(), count));
    }
  }

  /// Standard deviation of the samples of a pixel, from both axes; at least what rounding to 8 bits makes.
  double noise_at(const LitView& view, int y, int x) const {
    double variance = 0;
    each_axis(view, y, x, [&](bool, std::span<const std::uint16_t> samples) {
      variance += noise_variance(samples.last(kPhaseSteps)).value_or(0) / 2;
    });
    return std::max(1.0, std::sqrt(variance));
  }

  void finish_exposure(LitView& view) const {
    pool.rows(view.state.height(), [&](int begin, int end) {
      for (int y = begin; y < end; ++y)
        for (int x = 0; x < view.state.width(); ++x) {
          const double noise = noise_at(view, y, x);
          std::array<PlaceOnAxis, 2> axes;
          each_axis(view, y, x, [&](bool rows, std::span<const std::uint16_t> samples) {
            axes[rows] = place_on_axis(samples, code.period_px, rows ? code.screen.height : code.screen.width, noise);
          });
          const auto state = std::min(axes[0].state, axes[1].state);
          view.state.at(y, x) = std::max(view.state.at(y, x), static_cast<std::uint8_t>(state));
          const double clear = 16 * std::min(axes[0].amplitude, axes[1].amplitude) / noise;
          const int clarity = static_cast<int>(std::min(clear, 65535.0));
          if (state != LightState::kKnown || clarity <= view.clarity.at(y, x)) continue;
          view.clarity.at(y, x) = static_cast<std::uint16_t>(clarity);
          view.places.x_q8.at(y, x) = axes[0].place_q8;
          view.places.y_q8.at(y, x) = axes[1].place_q8;
        }
    });
    view.samples.clear();
  }
};

LightDecoder::LightDecoder(std::unique_ptr<State> state) : state_(std::move(state)) {}
LightDecoder::LightDecoder(LightDecoder&&) noexcept = default;
LightDecoder& LightDecoder::operator=(LightDecoder&&) noexcept = default;
LightDecoder::~LightDecoder() = default;

Result<LightDecoder> LightDecoder::open(const LightCode& code, const std::optional<Rig>& rig, Size raw, int threads) {
  DUO_TRY(check_light_code(code));
  std::optional<Rectification> maps;
  if (rig) {
    if (rig->left.size != raw)
      return Error{ErrorCode::kBadInput,
                   fmt::format("cannot decode pictures of {}x{} with this rig: it is of pictures of {}x{}", raw.width,
                               raw.height, rig->left.size.width, rig->left.size.height)};
    DUO_TRY_ASSIGN(maps, make_rectification(*rig, ""));
  }
  return LightDecoder(std::make_unique<State>(code, raw, std::move(maps), threads));
}

Result<void> LightDecoder::add(const Pair& pair) {
  State& s = *state_;
  for (const Picture* picture : {&pair.left, &pair.right})
    if (picture->pixels.size() != s.raw)
      return Error{ErrorCode::kBadInput,
                   fmt::format("cannot decode pictures of several sizes: pattern {} has {}x{}, the others have {}x{}", s.next,
                               picture->pixels.width(), picture->pixels.height(), s.raw.width, s.raw.height)};
  if (s.next == 0 && s.exposures == 0)
    s.light.left.pixels = pair.left.pixels.clone(), s.light.right.pixels = pair.right.pixels.clone();
  s.left.samples.push_back(State::brightness(pair.left.pixels));
  s.right.samples.push_back(State::brightness(pair.right.pixels));
  if (++s.next < s.patterns) return {};
  s.finish_exposure(s.left);
  s.finish_exposure(s.right);
  s.next = 0;
  ++s.exposures;
  return {};
}

Result<LightTruth> LightDecoder::truth(const Pair* light) const {
  const State& s = *state_;
  if (s.exposures == 0 || s.next != 0)
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot decode {} of {} patterns: each exposure needs all", s.next, s.patterns)};
  const Pair& shown = light != nullptr ? *light : s.light;
  for (const Picture* picture : {&shown.left, &shown.right})
    if (picture->pixels.size() != s.raw)
      return Error{ErrorCode::kBadInput,
                   fmt::format("cannot keep a picture of {}x{} as the scene's: those of the patterns have {}x{}",
                               picture->pixels.width(), picture->pixels.height(), s.raw.width, s.raw.height)};
  LightTruth out;
  if (s.maps) out.rectified = s.maps->geometry;
  out.pair.left.pixels = rectified_picture(s.pool, shown.left.pixels, s.map(true));
  out.pair.right.pixels = rectified_picture(s.pool, shown.right.pixels, s.map(false));
  out.left = count_states(s.left.state);
  out.right = count_states(s.right.state);
  ViewMatch match = match_views(s.pool, s.seen(s.left, s.map(true)), s.seen(s.right, s.map(false)), s.code);
  out.disparity_px = std::move(match.disparity_px);
  for (int y = 0; y < out.disparity_px.height(); ++y)
    for (int x = 0; x < out.disparity_px.width(); ++x)
      out.inside += !s.maps || s.maps->left.corner.at(y, x) != ResampleMap::kOutside;
  out.matched = match.matched;
  out.contradicting = match.contradicting;
  out.rows_px = match.rows_px;
  if (out.matched > 0) return out;
  return Error{
      ErrorCode::kBadInput,
      fmt::format(
          "no pixel is lit alike in both views: {:.0f} % of the left one's and {:.0f} % of the right one's have a place "
          "on the projector, {:.0f} and {:.0f} % are too dark, {:.0f} and {:.0f} % too bright; check the order of the "
          "patterns, the rig, and that left is left",
          percent_of(out.left.known, out.left.pixels), percent_of(out.right.known, out.right.pixels),
          percent_of(out.left.unlit, out.left.pixels), percent_of(out.right.unlit, out.right.pixels),
          percent_of(out.left.saturated, out.left.pixels), percent_of(out.right.saturated, out.right.pixels))};
}

}  // namespace duo
