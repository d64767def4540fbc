// Values out of a YAML document of another program; the first thing that is wrong is kept.
#pragma once

#include <yaml-cpp/yaml.h>

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace duo {

/// No list of numbers in a rig file is longer: a 4x4 matrix; OpenCV writes up to 14 coefficients.
inline constexpr std::size_t kMaxNumbers = 16;

/// A number, a list of numbers, rows of numbers, or a map with such a list as `data`. False when the node is something else.
bool read_numbers(const YAML::Node& node, std::vector<double>& out);
/// The same for numbers parted by white space, commas, semicolons or brackets.
bool read_numbers(std::string_view text, std::vector<double>& out);

class YamlReader {
 public:
  /// `whose` stands before a key in messages ("left camera: ").
  explicit YamlReader(const YAML::Node& map, std::string whose = "") : map_(map), whose_(std::move(whose)) {}
  const std::string& wrong() const { return wrong_; }

  /// The first key that is there; empty when there is none.
  std::string key_of(std::initializer_list<const char*> spellings) const;
  /// Empty when the key is missing or holds another count of numbers than the allowed ones.
  std::vector<double> numbers(const std::string& key, std::initializer_list<std::size_t> counts, const std::string& advice);
  /// A whole number up to 2^20; 0 when it is wrong.
  int whole(const std::string& key, double value);
  std::string text(const std::string& key, const std::string& advice);
  void complain(const std::string& what);

 private:
  const YAML::Node map_;
  std::string whose_, wrong_;
};

}  // namespace duo
