// Commands and options that do not exist, and what was perhaps meant.
#include <fmt/format.h>

#include <algorithm>

#include "duoptic/spelling.h"
#include "help.h"

namespace duo::app {
namespace {

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
