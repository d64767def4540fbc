#include "stages/balance/balance_vk.h"

#include "stages/balance/balance_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kBalanceSumsCode[] = {
#include "spirv/balance_sums.comp.inc"
};
constexpr std::uint32_t kBalanceTableCode[] = {
#include "spirv/balance_table.comp.inc"
};
constexpr std::uint32_t kBalanceCode[] = {
#include "spirv/balance.comp.inc"
};

}  // namespace

Result<Balance::Scratch> Balance::Scratch::make(const Device& device, Size size) {
  DUO_CHECK(!size.empty());
  Scratch out;
  out.size_ = size;
  const auto rows = std::size_t{2} * static_cast<std::size_t>(size.height);
  DUO_TRY_ASSIGN(out.rows_, Buffer::make(device, "balance sums", rows * kBalanceSums * sizeof(std::uint32_t), Memory::kDevice));
  DUO_TRY_ASSIGN(out.table_, Buffer::make(device, "balance table", 256 * sizeof(std::uint32_t), Memory::kDevice));
  return out;
}

Result<Balance> Balance::make(const Device& device) {
  Balance out;
  DUO_TRY_ASSIGN(out.sums_, Kernel::make(device, {"balance sums", kBalanceSumsCode, 5, sizeof(BalanceSumsPush)}));
  DUO_TRY_ASSIGN(out.table_, Kernel::make(device, {"balance table", kBalanceTableCode, 2, sizeof(BalanceTablePush)}));
  DUO_TRY_ASSIGN(out.look_up_, Kernel::make(device, {"balance", kBalanceCode, 3, sizeof(BalancePush)}));
  return out;
}

void Balance::record(Recorder& recorder, const Input& pair, const Scratch& scratch, BufferView<std::uint8_t> dst,
                     Size size) const {
  const bool masked = !pair.left_inside.absent();
  DUO_CHECK(scratch.size_ == size && pair.left.holds(size) && pair.right.holds(size) && dst.holds(size));
  DUO_CHECK(masked ? pair.left_inside.holds(size) && pair.right_inside.holds(size) : pair.right_inside.absent());
  const BalanceSumsPush sums{
      pair.left.plane, pair.right.plane, pair.left_inside.plane, pair.right_inside.plane, size.width, size.height, masked};
  // Every binding needs a buffer; the kernel does not look at those that stand in for absent ones.
  const auto present = [&](const auto& view) { return view.absent() ? reads(pair.left) : reads(view); };
  recorder.dispatch(
      sums_, sums,
      {reads(pair.left), reads(pair.right), present(pair.left_inside), present(pair.right_inside), writes(scratch.rows_)},
      {size.height, 2});
  recorder.dispatch(table_, BalanceTablePush{size.height}, {reads(scratch.rows_), writes(scratch.table_)}, {1, 1});
  recorder.dispatch(look_up_, BalancePush{pair.right.plane, dst.plane, size.width, size.height},
                    {reads(pair.right), reads(scratch.table_), writes(dst)}, groups_for(size));
}

}  // namespace duo::vk
