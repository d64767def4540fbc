#include "stages/median/median_vk.h"

#include "stages/median/median_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kMedianCode[] = {
#include "spirv/median.comp.inc"
};

Result<Kernel> make_median(const Device& device, const char* name, std::uint32_t pixel_bytes) {
  const std::uint32_t constants[] = {pixel_bytes};
  return Kernel::make(device, {name, kMedianCode, 2, sizeof(MedianPush), constants});
}

template <class T>
void record_median(const Kernel& kernel, Recorder& recorder, BufferView<T> src, BufferView<T> dst, Size size) {
  DUO_CHECK(src.holds(size) && dst.holds(size));
  const MedianPush push{src.plane, dst.plane, size.width, size.height};
  recorder.dispatch(kernel, push, {reads(src), writes(dst)}, groups_for(size));
}

}  // namespace

Result<Median> Median::make(const Device& device) {
  Median out;
  DUO_TRY_ASSIGN(out.u8_, make_median(device, "median u8", 1));
  DUO_TRY_ASSIGN(out.u16_, make_median(device, "median u16", 2));
  return out;
}

void Median::record(Recorder& recorder, BufferView<std::uint8_t> src, BufferView<std::uint8_t> dst, Size size) const {
  record_median(u8_, recorder, src, dst, size);
}

void Median::record(Recorder& recorder, BufferView<std::uint16_t> src, BufferView<std::uint16_t> dst, Size size) const {
  record_median(u16_, recorder, src, dst, size);
}

}  // namespace duo::vk
