// Numbers and states as the text sinks print them.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "duoptic/person.h"

namespace duo {

/// A number with `digits` decimals, so that every run prints the same, never "-0.00"; `otherwise` for what is none.
inline std::string number(double value, int digits, const char* otherwise = "null") {
  if (!std::isfinite(value)) return otherwise;
  const std::string text = fmt::format("{:.{}f}", value, digits);
  return text[0] == '-' && text.find_first_not_of("-0.") == std::string::npos ? text.substr(1) : text;
}

inline const char* state_text(JointState state) {
  constexpr const char* kStates[] = {"seen", "inferred", "lost"};
  return kStates[static_cast<int>(state)];
}

}  // namespace duo
