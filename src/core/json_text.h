// JSON as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace duo {

/// Of nlohmann's kinds of JSON. Bytes that are no UTF-8, of which names of files and devices may be, become U+FFFD: a plain
/// dump() would throw. `indent` -1: one line.
template <class Json = nlohmann::json>
std::string json_text(const Json& json, int indent = 2) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace duo
