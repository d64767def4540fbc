#include "matchers/pyramid/pyramid_vk.h"

#include "matchers/pyramid/pyramid.h"

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
  if (params.search != PyramidParams::Search::kAround)
    return Error{ErrorCode::kBadInput, "set up matcher pyramid on a device: only its preset \"thesis\" has kernels"};
  Pyramid out;
  out.params_ = params;
  out.masked_ = setup.masked;
  DUO_TRY_ASSIGN(out.halve_, Halve::make(device));
  DUO_TRY_ASSIGN(out.match_around_, MatchAround::make(device));
  DUO_TRY_ASSIGN(out.mark_invalid_, MarkInvalid::make(device));
  for (const LevelShape& shape : level_shapes(params, setup)) {
    DUO_TRY_ASSIGN(Level level, out.make_level(device, shape));
    out.levels_.push_back(std::move(level));
  }
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
  return out;
}

Pyramid::Input Pyramid::pair_of(const Input& full, std::size_t level) const {
  if (level == 0) return full;
  const Level& at = levels_[level];
  const auto view = [&](const Buffer& buffer) { return whole<std::uint8_t>(buffer, at.shape.size); };
  if (!masked_) return {view(at.left), view(at.right)};
  return {view(at.left), view(at.right), view(at.left_inside), view(at.right_inside)};
}

void Pyramid::record(Recorder& recorder, const Input& pair, BufferView<std::uint16_t> d_q4) const {
  DUO_CHECK(masked_ != pair.left_inside.absent());
  for (std::size_t i = 1; i < levels_.size(); ++i) {
    const Input from = pair_of(pair, i - 1), to = pair_of(pair, i);
    const Size size = levels_[i - 1].shape.size;
    halve_.record(recorder, from.left, to.left, size);
    halve_.record(recorder, from.right, to.right, size);
    if (!masked_) continue;
    halve_.record_inside(recorder, from.left_inside, to.left_inside, size);
    halve_.record_inside(recorder, from.right_inside, to.right_inside, size);
  }
  record_around(recorder, pair, d_q4);
}

void Pyramid::record_around(Recorder& recorder, const Input& pair, BufferView<std::uint16_t> d_q4) const {
  BufferView<std::int16_t> coarser;
  for (std::size_t i = levels_.size(); i-- > 0;) {
    const Input here = pair_of(pair, i);
    const Size size = levels_[i].shape.size;
    const auto winner = whole<std::int16_t>(levels_[i].left_winner, size);
    match_around_.record(
        recorder,
        {here.left, here.right, here.left_inside, here.right_inside, coarser, radius_of(params_, static_cast<int>(i))}, winner,
        size);
    coarser = winner;
  }
  const auto& [size, max_disparity] = levels_[0].shape;
  mark_invalid_.record(recorder, {coarser, pair.left_inside, pair.right_inside, max_disparity}, d_q4, size);
}

}  // namespace duo::vk
