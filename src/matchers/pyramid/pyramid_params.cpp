#include "matchers/pyramid/pyramid_params.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace duo {

Result<PyramidParams> pyramid_params(std::string_view preset, const Overrides& overrides) {
  PyramidParams params;
  if (preset == "thesis")
    params.search = PyramidParams::Search::kAround, params.balance = 0;
  else if (preset != "default")
    return Error{ErrorCode::kBadInput, fmt::format("set up matcher pyramid: no preset is called \"{}\"; choose one of: {}",
                                                   preset, fmt::join(kPyramidPresets, ", "))};
  DUO_TRY(override_parameters<PyramidParams>("matcher pyramid", kPyramidParameters, overrides, params));
  return params;
}

}  // namespace duo
