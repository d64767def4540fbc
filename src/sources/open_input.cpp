#include <fmt/format.h>

#include "duoptic/source.h"

namespace duo {

Result<Input> open_input(const std::string& left, const std::string& right, const std::optional<Rig>& rig, PairWish wish) {
  if (rig) wish.cameras.size = rig->left.size;
  Input input{nullptr, rig, {left}};
  if (!right.empty()) input.names.push_back(right);
  DUO_TRY_ASSIGN(input.pairs, open_pairs(left, right, wish));
  if (!rig) input.rig = input.pairs->rig();
  const Size half = input.pairs->size();
  if (right.empty() && rig &&
      (rig->left.size == Size{2 * half.width, half.height} || rig->left.size == Size{half.width, 2 * half.height}))
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot use {} as two views: it has the {}x{} pixels that one view of the rig has; give "
                             "LEFT and RIGHT, or the rig of its halves",
                             left, rig->left.size.width, rig->left.size.height)};
  return input;
}

}  // namespace duo
