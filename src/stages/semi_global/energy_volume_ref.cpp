#include <algorithm>
#include <vector>

#include "core/check.h"
#include "stages/semi_global/energy_volume.h"
#include "stages/semi_global/volume_ref.h"

namespace duo::ref {

void energy_volume(const SemiGlobal& in, EnergyVolume& out) {
  const int n = in.max_disparity;
  DUO_CHECK(out.size() == in.left.size() && out.max_disparity() == n && in.params.paths() == 3);
  Volume costs = costs_of(in), sums(out.size(), n);
  for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}}) add_path(in, costs, dx, dy, sums);
  for (int y = 0; y < out.size().height; ++y)
    for (int x = 0; x < out.size().width; ++x) {
      const std::uint8_t *c = costs.at(y, x), *s = sums.at(y, x);
      const int least = *std::min_element(s, s + n);
      for (int d = 0; d < n; ++d)
        out.cell(y, x)[out.lanes() - 1 - d] = static_cast<std::uint8_t>(EnergyOf::energy(c[d], s[d], least));
    }
}

}  // namespace duo::ref
