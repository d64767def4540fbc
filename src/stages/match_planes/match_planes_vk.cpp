#include "stages/match_planes/match_planes_vk.h"

#include "stages/match_planes/match_planes_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kMatchPlanesCode[] = {
#include "spirv/match_planes.comp.inc"
};

}  // namespace

Size MatchPlanes::packed_size(Size size) { return {size.width, kMatchPlanes * size.height}; }

Result<MatchPlanes> MatchPlanes::make(const Device& device) {
  MatchPlanes out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"match planes", kMatchPlanesCode, 5, sizeof(MatchPlanesPush)}));
  return out;
}

void MatchPlanes::record(Recorder& recorder, BufferView<std::uint8_t> gray, BufferView<std::uint8_t> inside,
                         const Buffer& noise_q4, const Buffer& clear, BufferView<std::uint32_t> planes, Size size) const {
  const bool masked = !inside.absent();
  DUO_CHECK(gray.holds(size) && planes.holds(packed_size(size)) && (!masked || inside.holds(size)));
  const MatchPlanesPush push{gray.plane, inside.plane, planes.plane, size.width, size.height, masked};
  // Every binding needs a buffer; the kernel does not look at the one that stands in for an absent one.
  recorder.dispatch(kernel_, push,
                    {reads(gray), masked ? reads(inside) : reads(gray), reads(noise_q4), reads(clear), writes(planes)},
                    groups_for(size));
}

}  // namespace duo::vk
