#include "matchers/fine/fine_params.h"

#include <fmt/ranges.h>

#include <algorithm>

namespace duo {

SgmParams FineParams::sgm() const {
  SgmParams out;
  out.soften = soften, out.clear = clear, out.speckle = speckle;
  out.refine = 0;  // planes are what is refined
  return out;
}

Result<FineParams> fine_params(std::string_view preset, const Overrides& overrides) {
  FineParams params;
  if (std::ranges::find(kFinePresets, preset) == std::end(kFinePresets))
    return Error{ErrorCode::kBadInput, fmt::format("set up matcher fine: no preset is called \"{}\"; choose one of: {}", preset,
                                                   fmt::join(kFinePresets, ", "))};
  DUO_TRY(override_parameters<FineParams>("matcher fine", kFineParameters, overrides, params));
  return params;
}

}  // namespace duo
