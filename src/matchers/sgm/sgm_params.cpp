#include "matchers/sgm/sgm_params.h"

#include <fmt/ranges.h>

namespace duo {

SemiGlobalParams SgmParams::semi_global(bool even) const {
  return {census_truncation,       truncation, p1, p2, even ? p2 : p2_least, p2_gradient, paths == 5 || paths == 8,
          paths == 4 || paths == 8};
}

Result<SgmParams> sgm_params(std::string_view preset, const Overrides& overrides) {
  SgmParams params;
  if (preset == "paths8")
    params.paths = 8;
  else if (preset != "default")
    return Error{ErrorCode::kBadInput, fmt::format("set up matcher sgm: no preset is called \"{}\"; choose one of: {}", preset,
                                                   fmt::join(kSgmPresets, ", "))};
  DUO_TRY(override_parameters<SgmParams>("matcher sgm", kSgmParameters, overrides, params));
  if (params.paths == 6 || params.paths == 7)
    return Error{ErrorCode::kBadInput,
                 fmt::format("set up matcher sgm: paths = {} does not exist; choose one of: 3, 4, 5, 8", params.paths)};
  if (params.p2_least < params.p1 || params.p2 < params.p2_least)
    return Error{
        ErrorCode::kBadInput,
        fmt::format("set up matcher sgm: penalties p1 = {}, p2-least = {}, p2 = {} do not rise; choose p1 <= p2-least <= p2",
                    params.p1, params.p2_least, params.p2)};
  return params;
}

}  // namespace duo
