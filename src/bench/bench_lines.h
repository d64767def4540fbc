// A table's lines as they become known.
#pragma once

#include <fmt/format.h>

#include <utility>

#include "duoptic/bench.h"

namespace duo {

template <class... T>
void say_format(const SayLine& say, fmt::format_string<T...> text, T&&... values) {
  say(fmt::format(text, std::forward<T>(values)...));
}

}  // namespace duo
