// Parameters declared once: a struct with defaults and a table of its members, from which flags, JSON and docs are made.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "duoptic/result.h"

namespace duo {

template <class Params>
struct Parameter {
  const char* name;
  int Params::*member;
  const char* unit;
  int min, max;
  const char* help;
};

using Overrides = std::vector<std::pair<std::string, double>>;

/// Sets the named members of `params`; `whose` names their owner in messages.
///
/// Errors  unknown name, value out of range or not whole: with what is known or allowed
template <class Params>
Result<void> override_parameters(std::string_view whose, std::span<const Parameter<Params>> table, const Overrides& overrides,
                                 Params& params) {
  for (const auto& [name, value] : overrides) {
    const Parameter<Params>* found = nullptr;
    for (const auto& parameter : table)
      if (name == parameter.name) found = &parameter;
    if (found == nullptr)
      return Error{ErrorCode::kBadInput,
                   fmt::format("set up {}: no parameter is called \"{}\"; see --help for their names", whose, name)};
    if (!(value >= found->min && value <= found->max) || value != std::floor(value))
      return Error{ErrorCode::kBadInput, fmt::format("set up {}: {} = {} is not a whole number in {} .. {}; choose one", whose,
                                                     name, value, found->min, found->max)};
    params.*found->member = static_cast<int>(value);
  }
  return {};
}

}  // namespace duo
