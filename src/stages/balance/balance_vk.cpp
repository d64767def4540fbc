#include "stages/balance/balance_vk.h"

#include <algorithm>
#include <string>

namespace duo::vk {
namespace {

constexpr std::uint32_t kBalanceCellsCode[] = {
#include "spirv/balance_cells.comp.inc"
};
constexpr std::uint32_t kBalanceCensusCode[] = {
#include "spirv/balance_census.comp.inc"
};
constexpr std::uint32_t kBalanceSumsCode[] = {
#include "spirv/balance_sums.comp.inc"
};
constexpr std::uint32_t kBalanceTableCode[] = {
#include "spirv/balance_table.comp.inc"
};
constexpr std::uint32_t kBalanceCode[] = {
#include "spirv/balance.comp.inc"
};

/// Whole ones in a picture.
Size cells_of(Size picture) { return {picture.width / kBalanceCell, picture.height / kBalanceCell}; }

}  // namespace

Result<Balance::Scratch> Balance::Scratch::make(const Device& device, Size size) {
  DUO_CHECK(!size.empty());
  Scratch out;
  out.size_ = size;
  const auto words = [&](const std::string& name, int count) {
    return Buffer::make(device, "balance " + name, sizeof(std::uint32_t) * static_cast<std::size_t>(std::max(count, 1)),
                        Memory::kDevice);
  };
  const Size cells = cells_of(size);
  DUO_TRY_ASSIGN(out.cells_, words("cells", 2 * cells.width * cells.height));
  DUO_TRY_ASSIGN(out.census_, words("census", 2 * cells.width * cells.height));
  DUO_TRY_ASSIGN(out.rows_, words("sums", 2 * cells.height * kBalanceSums));
  DUO_TRY_ASSIGN(out.table_, words("table", 256));
  return out;
}

Result<Balance> Balance::make(const Device& device) {
  Balance out;
  DUO_TRY_ASSIGN(out.cells_, Kernel::make(device, {"balance cells", kBalanceCellsCode, 5, sizeof(BalanceCellsPush)}));
  DUO_TRY_ASSIGN(out.census_, Kernel::make(device, {"balance census", kBalanceCensusCode, 2, sizeof(BalanceCensusPush)}));
  DUO_TRY_ASSIGN(out.sums_, Kernel::make(device, {"balance sums", kBalanceSumsCode, 3, sizeof(BalanceSumsPush)}));
  DUO_TRY_ASSIGN(out.table_, Kernel::make(device, {"balance table", kBalanceTableCode, 3, sizeof(BalanceTablePush)}));
  DUO_TRY_ASSIGN(out.look_up_, Kernel::make(device, {"balance", kBalanceCode, 3, sizeof(BalancePush)}));
  return out;
}

void Balance::record(Recorder& recorder, const Input& pair, int max_disparity, const Buffer* clear, const Scratch& scratch,
                     BufferView<std::uint8_t> dst, Size size) const {
  const bool masked = !pair.left_inside.absent();
  DUO_CHECK(scratch.size_ == size && pair.left.holds(size) && pair.right.holds(size) && dst.holds(size));
  DUO_CHECK(masked ? pair.left_inside.holds(size) && pair.right_inside.holds(size) : pair.right_inside.absent());
  DUO_CHECK(max_disparity >= 1);
  const auto [across, down] = cells_of(size);
  // Of a picture without a cell the table is made from no row.
  if (across > 0 && down > 0) {
    // Every binding needs a buffer; the kernel does not look at those that stand in for absent ones.
    const auto present = [&](const auto& view) { return view.absent() ? reads(pair.left) : reads(view); };
    recorder.dispatch(
        cells_,
        BalanceCellsPush{pair.left.plane, pair.right.plane, pair.left_inside.plane, pair.right_inside.plane, across, down,
                         masked},
        {reads(pair.left), reads(pair.right), present(pair.left_inside), present(pair.right_inside), writes(scratch.cells_)},
        groups_for({across, 2 * down}));
    recorder.dispatch(census_, BalanceCensusPush{across, down}, {reads(scratch.cells_), writes(scratch.census_)},
                      groups_for({across, 2 * down}));
    recorder.dispatch(sums_, BalanceSumsPush{across, down, most_cells_apart(max_disparity)},
                      {reads(scratch.cells_), reads(scratch.census_), writes(scratch.rows_)}, {down, 1});
  }
  recorder.dispatch(table_, BalanceTablePush{across > 0 ? down : 0, clear != nullptr},
                    {reads(scratch.rows_), writes(scratch.table_), reads(clear != nullptr ? *clear : scratch.rows_)}, {1, 1});
  recorder.dispatch(look_up_, BalancePush{pair.right.plane, dst.plane, size.width, size.height},
                    {reads(pair.right), reads(scratch.table_), writes(dst)}, groups_for(size));
}

}  // namespace duo::vk
