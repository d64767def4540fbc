#include "matchers/pyramid/pyramid_vk.h"

#include <utility>

namespace duo::vk {
namespace {

template <class T>
Result<Buffer> make_image(const Device& device, const std::string& name, Size size) {
  return Buffer::make(device, "pyramid " + name, sizeof(T) * size.width * size.height, Memory::kDevice);
}

template <class T>
BufferView<T> whole(const Buffer& buffer, Size size) {
  return {buffer, {0, size.width}};
}

}  // namespace

Result<Pyramid> Pyramid::make(const Device& device, const PyramidParams& params, const MatchSetup& setup) {
  Pyramid out;
  out.params_ = params;
  out.masked_ = setup.masked;
  DUO_TRY_ASSIGN(out.halve_, Halve::make(device));
  if (params.balance != 0) {
    DUO_TRY_ASSIGN(out.balanced_, make_balanced(device, setup.size));
  }
  if (params.search == PyramidParams::Search::kAround) {
    DUO_TRY_ASSIGN(out.around_, make_around(device));
  } else {
    DUO_TRY_ASSIGN(out.tiles_, make_tiles(device, setup.size));
  }
  for (const LevelShape& shape : level_shapes(params, setup)) {
    DUO_TRY_ASSIGN(Level level, out.make_level(device, shape));
    out.levels_.push_back(std::move(level));
  }
  return out;
}

Result<Pyramid::Balanced> Pyramid::make_balanced(const Device& device, Size size) {
  Balanced out;
  DUO_TRY_ASSIGN(out.balance, Balance::make(device));
  DUO_TRY_ASSIGN(out.scratch, Balance::Scratch::make(device, size));
  DUO_TRY_ASSIGN(out.right, make_image<std::uint8_t>(device, "balanced", size));
  return out;
}

Result<Pyramid::Around> Pyramid::make_around(const Device& device) {
  Around out;
  DUO_TRY_ASSIGN(out.match, MatchAround::make(device));
  DUO_TRY_ASSIGN(out.mark_invalid, MarkInvalid::make(device));
  return out;
}

Result<Pyramid::Tiles> Pyramid::make_tiles(const Device& device, Size size) {
  Tiles out;
  DUO_TRY_ASSIGN(out.match, MatchTiles::make(device));
  DUO_TRY_ASSIGN(out.check, CheckLeftRight::make(device));
  DUO_TRY_ASSIGN(out.candidates, TileCandidates::make(device));
  DUO_TRY_ASSIGN(out.median, Median::make(device));
  DUO_TRY_ASSIGN(out.speckle, RemoveSpeckle::make(device));
  DUO_TRY_ASSIGN(out.speckle_scratch, RemoveSpeckle::Scratch::make(device, size));
  DUO_TRY_ASSIGN(out.filtered, make_image<std::uint16_t>(device, "filtered", size));
  return out;
}

Result<Pyramid::Level> Pyramid::make_level(const Device& device, const LevelShape& shape) const {
  Level out{.shape = shape};
  const Size size = shape.size;
  if (!levels_.empty()) {
    DUO_TRY_ASSIGN(out.left, make_image<std::uint8_t>(device, "left", size));
    DUO_TRY_ASSIGN(out.right, make_image<std::uint8_t>(device, "right", size));
    if (masked_) {
      DUO_TRY_ASSIGN(out.left_inside, make_image<std::uint8_t>(device, "left inside", size));
      DUO_TRY_ASSIGN(out.right_inside, make_image<std::uint8_t>(device, "right inside", size));
    }
  }
  DUO_TRY_ASSIGN(out.left_winner, make_image<std::int16_t>(device, "left winner", size));
  if (tiles_) {
    DUO_TRY_ASSIGN(out.right_winner, make_image<std::int16_t>(device, "right winner", size));
    DUO_TRY_ASSIGN(out.checked, make_image<std::int16_t>(device, "checked", size));
    DUO_TRY_ASSIGN(out.fine, make_image<std::uint16_t>(device, "fine", size));
    DUO_TRY_ASSIGN(out.sets, make_image<std::uint32_t>(device, "sets", TileSets::shape32(size, shape.max_disparity)));
    DUO_TRY_ASSIGN(out.scratch, MatchTiles::Scratch::make(device, size));
  }
  return out;
}

MatchInput Pyramid::pair_of(const Input& full, std::size_t level) const {
  if (level == 0) return full;
  const Level& at = levels_[level];
  const auto view = [&](const Buffer& buffer) { return whole<std::uint8_t>(buffer, at.shape.size); };
  if (!masked_) return {view(at.left), view(at.right)};
  return {view(at.left), view(at.right), view(at.left_inside), view(at.right_inside)};
}

void Pyramid::record(Recorder& recorder, const Input& raw, const MatchOutput& out) const {
  DUO_CHECK(masked_ != raw.left_inside.absent());
  Input pair = raw;
  if (balanced_) {
    const auto& [size, max_disparity] = levels_[0].shape;
    pair.right = whole<std::uint8_t>(balanced_->right, size);
    balanced_->balance.record(recorder, {raw.left, raw.right, raw.left_inside, raw.right_inside}, max_disparity, nullptr,
                              balanced_->scratch, pair.right, size);
    recorder.stage("balance");
  }
  record_halving(recorder, pair);
  recorder.stage("halve");
  around_ ? record_around(recorder, pair, out.d_q4) : record_tiles(recorder, pair, out.d_q4);
}

void Pyramid::record_halving(Recorder& recorder, const Input& pair) const {
  for (std::size_t i = 1; i < levels_.size(); ++i) {
    const Input from = pair_of(pair, i - 1), to = pair_of(pair, i);
    const Size size = levels_[i - 1].shape.size;
    halve_.record(recorder, from.left, to.left, size);
    halve_.record(recorder, from.right, to.right, size);
    if (!masked_) continue;
    halve_.record_inside(recorder, from.left_inside, to.left_inside, size);
    halve_.record_inside(recorder, from.right_inside, to.right_inside, size);
  }
}

void Pyramid::record_around(Recorder& recorder, const Input& pair, BufferView<std::uint16_t> d_q4) const {
  BufferView<std::int16_t> coarser;
  for (std::size_t i = levels_.size(); i-- > 0;) {
    const Input here = pair_of(pair, i);
    const Size size = levels_[i].shape.size;
    const auto winner = whole<std::int16_t>(levels_[i].left_winner, size);
    const int radius = radius_of(params_, static_cast<int>(i));
    around_->match.record(recorder, {here.left, here.right, here.left_inside, here.right_inside, coarser, radius}, winner,
                          size);
    coarser = winner;
  }
  recorder.stage("match_around");
  const auto& [size, max_disparity] = levels_[0].shape;
  around_->mark_invalid.record(recorder, {coarser, pair.left_inside, pair.right_inside, max_disparity}, d_q4, size);
  recorder.stage("mark_invalid");
}

void Pyramid::record_tiles(Recorder& recorder, const Input& pair, BufferView<std::uint16_t> d_q4) const {
  // Channels of all levels first: they depend on pictures only, so nothing has to wait between them.
  for (std::size_t i = 0; i < levels_.size(); ++i)
    tiles_->match.record_channels(recorder, tiles_input(pair, i), tiles_params(i), levels_[i].scratch);
  for (std::size_t i = levels_.size(); i-- > 0;) {
    const Level& level = levels_[i];
    const Size size = level.shape.size;
    tiles_->match.record(recorder, tiles_input(pair, i), tiles_params(i), level.scratch,
                         {whole<std::int16_t>(level.left_winner, size), whole<std::int16_t>(level.right_winner, size),
                          whole<std::uint16_t>(level.fine, size)});
    recorder.stage("match_tiles");
    if (i > 0) record_candidates(recorder, pair, i);
  }
  record_checked(recorder, pair, d_q4);
}

MatchTiles::Input Pyramid::tiles_input(const Input& pair, std::size_t level) const {
  const Input here = pair_of(pair, level);
  const auto& [size, max_disparity] = levels_[level].shape;
  MatchTiles::Input out{here.left, here.right, here.left_inside, here.right_inside, {}, max_disparity};
  if (level + 1 < levels_.size()) out.sets = sets_of(level);
  return out;
}

MatchTilesParams Pyramid::tiles_params(std::size_t level) const { return {params_.truncation, params_.sobel_clip, level == 0}; }

BufferView<std::uint32_t> Pyramid::sets_of(std::size_t level) const {
  const auto& [size, max_disparity] = levels_[level].shape;
  return whole<std::uint32_t>(levels_[level].sets, TileSets::shape32(size, max_disparity));
}

/// What a level found becomes the candidates of the next finer one.
void Pyramid::record_candidates(Recorder& recorder, const Input& pair, std::size_t coarser) const {
  const Level& level = levels_[coarser];
  const Input here = pair_of(pair, coarser);
  const Size size = level.shape.size;
  const auto left = whole<std::int16_t>(level.left_winner, size), right = whole<std::int16_t>(level.right_winner, size),
             checked = whole<std::int16_t>(level.checked, size);
  tiles_->check.record_winners(recorder, {left, right, here.left_inside, here.right_inside, params_.tolerance, 0}, checked,
                               size);
  const auto& [finer_size, max_disparity] = levels_[coarser - 1].shape;
  tiles_->candidates.record(recorder, {checked, left, params_.grow, params_.margin}, sets_of(coarser - 1), finer_size,
                            max_disparity);
  recorder.stage("tile_candidates");
}

void Pyramid::record_checked(Recorder& recorder, const Input& pair, BufferView<std::uint16_t> d_q4) const {
  const Level& full = levels_[0];
  const Size size = full.shape.size;
  // Medians go back and forth between two images; the check starts in the one from which the last median ends in d_q4.
  BufferView<std::uint16_t> now = d_q4, next = whole<std::uint16_t>(tiles_->filtered, size);
  if (params_.medians % 2 != 0) std::swap(now, next);
  const auto left = whole<std::int16_t>(full.left_winner, size), right = whole<std::int16_t>(full.right_winner, size);
  tiles_->check.record(recorder, {left, right, pair.left_inside, pair.right_inside, params_.tolerance, params_.reach},
                       whole<std::uint16_t>(full.fine, size), now, size);
  recorder.stage("check_left_right");
  for (int i = 0; i < params_.medians; ++i, std::swap(now, next)) tiles_->median.record(recorder, now, next, size);
  recorder.stage("median");
  tiles_->speckle.record(recorder, d_q4, params_.speckle_step_q4, params_.speckle, tiles_->speckle_scratch, size);
  recorder.stage("speckle");
}

}  // namespace duo::vk
