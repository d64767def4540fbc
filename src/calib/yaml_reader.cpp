#include "calib/yaml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace duo {
namespace {

bool append_numbers(const YAML::Node& node, int depth, std::vector<double>& out) {
  if (double number; node.IsScalar() && YAML::convert<double>::decode(node, number)) {
    out.push_back(number);
    return out.size() <= kMaxNumbers;
  }
  if (depth == 2 || !node.IsSequence() || node.size() > kMaxNumbers) return false;
  return std::all_of(node.begin(), node.end(), [&](const YAML::Node& item) { return append_numbers(item, depth + 1, out); });
}

}  // namespace

bool read_numbers(const YAML::Node& node, std::vector<double>& out) {
  const YAML::Node data = node.IsMap() ? node["data"] : node;
  return data.IsDefined() && append_numbers(data, 0, out);
}

bool read_numbers(std::string_view text, std::vector<double>& out) {
  constexpr std::string_view kBetween = " \t\r\n,;[]";
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(kBetween), text.size()));
    if (text.empty()) return true;
    if (text.front() == '+') text.remove_prefix(1);
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (error != std::errc() || out.size() == kMaxNumbers || (!text.empty() && kBetween.find(text.front()) == kBetween.npos))
      return false;
    out.push_back(number);
  }
}

std::string YamlReader::key_of(std::initializer_list<const char*> spellings) const {
  for (const char* key : spellings)
    if (map_[key].IsDefined()) return key;
  return {};
}

std::vector<double> YamlReader::numbers(const std::string& key, std::initializer_list<std::size_t> counts,
                                        const std::string& advice) {
  std::vector<double> out;
  if (!map_[key].IsDefined()) {
    complain(fmt::format("key '{}' is missing; {}", key, advice));
  } else if (!read_numbers(map_[key], out)) {
    complain(fmt::format("key '{}' is not a list of at most {} numbers", key, kMaxNumbers));
  } else if (std::find(counts.begin(), counts.end(), out.size()) == counts.end()) {
    complain(fmt::format("key '{}' has {} numbers; {}", key, out.size(), advice));
  } else {
    return out;
  }
  return {};
}

int YamlReader::whole(const std::string& key, double value) {
  if (value == std::floor(value) && std::abs(value) <= 1 << 20) return static_cast<int>(value);
  complain(fmt::format("key '{}' is {}, not a size in pixels", key, value));
  return 0;
}

std::string YamlReader::text(const std::string& key, const std::string& advice) {
  const YAML::Node node = map_[key];
  if (node.IsDefined() && node.IsScalar()) return node.Scalar();
  complain(fmt::format("key '{}' is missing or no text; {}", key, advice));
  return {};
}

void YamlReader::complain(const std::string& what) {
  if (wrong_.empty()) wrong_ = whose_ + what;
}

}  // namespace duo
