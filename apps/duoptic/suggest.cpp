// Commands and options that do not exist, and what was perhaps meant.
#include <fmt/format.h>

#include <algorithm>

#include "help.h"

namespace duo::app {
namespace {

/// Letters that are missing, too many, other ones, or changed places with a neighbour.
///
/// Source  Damerau, "A technique for computer detection and correction of spelling errors", 1964
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

std::string bare(const std::string& word) { return word.substr(std::min(word.find_first_not_of('-'), word.size())); }

/// The likeliest of `names`: few letters differ, or one is part of the other; empty: none is like it.
std::string likeliest(const std::string& word, const std::vector<std::string>& names) {
  const std::string meant = bare(word);
  std::string best;
  double least = 1;
  for (const std::string& name : names) {
    const std::string known = bare(name);
    const std::size_t letters = std::min(meant.size(), known.size());
    const bool begins = letters >= 2 && meant.compare(0, letters, known, 0, letters) == 0;
    const bool inside =
        letters >= 3 && (known.find("-" + meant) != std::string::npos || meant.find("-" + known) != std::string::npos);
    const std::size_t off = distance(meant, known);
    const double share = static_cast<double>(off) / (1.5 + static_cast<double>(letters) / 3);
    const double badness = begins ? std::min(share, 0.4) : inside ? std::min(share, 0.6) : share;
    if (badness < least) best = name, least = badness;
  }
  return best;
}

const CLI::Option* option_of(const CLI::App& command, const std::string& name) {
  for (const CLI::App* at = &command; at != nullptr; at = at->get_parent())
    if (const CLI::Option* option = at->get_option_no_throw(name)) return option;
  return nullptr;
}

std::string unknown_option(const CLI::App& duoptic, const CLI::App& command, const std::string& word) {
  const std::string name = name_of(command);
  std::vector<std::string> names;
  for (const CLI::App* at = &command; at != nullptr; at = at->get_parent())
    for (const CLI::Option* option : options_of(*at, false))
      for (const std::string& known : option->get_lnames()) names.push_back("--" + known);
  std::string out = fmt::format("{} has no option {}", name.empty() ? "duoptic" : name, word);
  if (const std::string meant = likeliest(word, names); !meant.empty()) return out + fmt::format("; did you mean {}?", meant);
  for (const CLI::App* other : commands_of(duoptic))
    if (option_of(*other, word) != nullptr) return out + fmt::format("; duoptic {} has", other->get_name());
  return out;
}

}  // namespace

std::string unknown_word(const CLI::App& duoptic, std::span<const std::string> words) {
  const CLI::App* at = &duoptic;
  for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
    const std::string& word = words[i];
    if (word.size() > 1 && word[0] == '-' && !(word[1] >= '0' && word[1] <= '9') && word[1] != '.') {
      const bool is_long = word[1] == '-';
      const std::string name = is_long ? word.substr(0, word.find('=')) : word.substr(0, 2);
      const CLI::Option* option = option_of(*at, name);
      if (option == nullptr) return unknown_option(duoptic, *at, name);
      const bool whole = name == word;  // its value, if it takes one, is the next word
      if (whole) i += static_cast<std::size_t>(option->get_items_expected_min());
      continue;
    }
    const auto commands = commands_of(*at);
    if (commands.empty()) continue;
    std::vector<std::string> names;
    for (const CLI::App* command : commands) names.push_back(command->get_name());
    const auto found = std::find(names.begin(), names.end(), word);
    if (found != names.end()) {
      at = commands[static_cast<std::size_t>(found - names.begin())];
      continue;
    }
    const std::string name = name_of(*at), meant = likeliest(word, names);
    return fmt::format("there is no command '{}'{}", name.empty() ? word : name + " " + word,
                       meant.empty() ? "" : fmt::format("; did you mean {}{}?", name.empty() ? "" : name + " ", meant));
  }
  return "";
}

}  // namespace duo::app
