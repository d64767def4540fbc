// A pair as matching would see it, in colour: to look at.
#include "calib/rectification.h"
#include "calib/rig_formats.h"
#include "duoptic/calibrate.h"

namespace duo {

Result<Pair> rectify_pair(const Rig& rig, const Pair& pair) {
  if (pair.left.pixels.size() != rig.left.size || pair.right.pixels.size() != rig.right.size)
    return rig_error("", "its pictures have another size than the rig's");
  DUO_TRY_ASSIGN(const Rectification maps, make_rectification(rig, ""));
  Pool pool(1);
  Pair out;
  out.left.pixels = Image<Rgb8>(maps.geometry.size), out.right.pixels = Image<Rgb8>(maps.geometry.size);
  simd::rectify(pool, pair.left.pixels, maps.left, out.left.pixels);
  simd::rectify(pool, pair.right.pixels, maps.right, out.right.pixels);
  return out;
}

}  // namespace duo
