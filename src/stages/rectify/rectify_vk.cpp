#include "stages/rectify/rectify_vk.h"

#include "stages/rectify/rectify_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kRectifyCode[] = {
#include "spirv/rectify.comp.inc"
};

Result<Kernel> make_rectify(const Device& device, const char* name, std::uint32_t channels) {
  const std::uint32_t constants[] = {channels};
  return Kernel::make(device, {name, kRectifyCode, 5, sizeof(RectifyPush), constants});
}

template <class T>
void record_rectify(const Kernel& kernel, Recorder& recorder, BufferView<T> src, const Rectify::Map& map, BufferView<T> dst,
                    BufferView<std::uint8_t> inside, Size size, ResampleMap::Columns columns) {
  const bool marks_inside = !inside.absent();
  DUO_CHECK(!src.absent() && map.corner.holds(size) && map.fraction_q8.holds(size) && dst.holds(size));
  DUO_CHECK(!marks_inside || inside.holds(size));
  const RectifyPush push{src.plane,   map.corner.plane, map.fraction_q8.plane,     dst.plane,     inside.plane, size.width,
                         size.height, marks_inside,     static_cast<int>(columns), map.raw_height};
  // Every binding needs a buffer; the kernel does not touch the one that stands in for an absent picture.
  const Use marks = marks_inside ? writes(inside) : writes(dst);
  recorder.dispatch(kernel, push, {reads(src), reads(map.corner), reads(map.fraction_q8), writes(dst), marks},
                    groups_for(size));
}

}  // namespace

Result<Rectify> Rectify::make(const Device& device) {
  Rectify out;
  DUO_TRY_ASSIGN(out.gray_, make_rectify(device, "rectify gray", 1));
  DUO_TRY_ASSIGN(out.color_, make_rectify(device, "rectify color", 3));
  return out;
}

void Rectify::record(Recorder& recorder, BufferView<std::uint8_t> src, const Map& map, BufferView<std::uint8_t> dst,
                     BufferView<std::uint8_t> inside, Size size) const {
  record_rectify(gray_, recorder, src, map, dst, inside, size, map.columns);
}

void Rectify::record(Recorder& recorder, BufferView<Rgb8> src, const Map& map, BufferView<Rgb8> dst, Size size) const {
  record_rectify(color_, recorder, src, map, dst, {}, size, ResampleMap::Columns::kLinear);
}

}  // namespace duo::vk
