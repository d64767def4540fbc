#include "matchers/pyramid/pyramid_params.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace duo {

Result<PyramidParams> pyramid_params(std::string_view preset, const std::vector<std::pair<std::string, double>>& overrides) {
  PyramidParams params;
  if (preset == "thesis")
    params.search = PyramidParams::Search::kAround;
  else if (preset != "default")
    return Error{ErrorCode::kBadInput, fmt::format("set up matcher pyramid: no preset is called \"{}\"; choose one of: {}", preset,
                                                   fmt::join(kPyramidPresets, ", "))};
  for (const auto& [name, value] : overrides) {
    const Parameter<PyramidParams>* found = nullptr;
    for (const auto& parameter : kPyramidParameters)
      if (name == parameter.name) found = &parameter;
    if (found == nullptr)
      return Error{ErrorCode::kBadInput,
                   fmt::format("set up matcher pyramid: no parameter is called \"{}\"; see --help for their names", name)};
    if (!(value >= found->min && value <= found->max) || value != std::floor(value))
      return Error{ErrorCode::kBadInput, fmt::format("set up matcher pyramid: {} = {} is not a whole number in {} .. {}; choose one",
                                                     name, value, found->min, found->max)};
    params.*found->member = static_cast<int>(value);
  }
  return params;
}

}  // namespace duo
