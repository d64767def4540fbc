#include "help.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace duo::app {
namespace {

constexpr int kFewestColumns = 40, kMostColumns = 100;

std::string blanks(int count) { return std::string(static_cast<std::size_t>(std::max(count, 0)), ' '); }

/// Words in lines of `columns`, which begin at `indent`; the first line has `used` columns already. A line that goes on ends
/// with `end`.
std::string wrapped(const std::string& text, int indent, int columns, int used = 0, const std::string& end = "") {
  std::string out;
  int at = used;
  std::istringstream words(text);
  bool first = true;
  for (std::string word; words >> word; first = false) {
    const int size = static_cast<int>(word.size());
    if (!first && at + 1 + size + static_cast<int>(end.size()) > columns) {
      out += end + "\n" + blanks(indent);
      at = indent;
    } else if (!first) {
      out += ' ', ++at;
    }
    out += word, at += size;
  }
  return out + "\n";
}

std::string example_text(const Paragraph& example, int columns) {
  const std::string line = "  " + example.text + (example.note.empty() ? "" : "   " + example.note);
  if (static_cast<int>(line.size()) <= columns) return line + "\n";
  const std::string note = example.note.empty() ? "" : "  # " + wrapped(example.note, 4, columns, 4);
  return note + "  " + wrapped(example.text, 6, columns, 2, " \\");
}

std::string footer_text(const std::string& footer, int columns) {
  std::string out;
  for (const Paragraph& p : paragraphs_of(footer))
    out += p.example ? example_text(p, columns) : "\n" + wrapped(p.text, 0, columns);
  return out;
}

/// A name and what it means, in two columns.
std::string row(const std::string& name, const std::string& text, int columns) {
  const int indent = columns < 70 ? 10 : 24, used = static_cast<int>(name.size()) + 2;
  const std::string gap = used + 2 > indent ? "\n" + blanks(indent) : blanks(indent - used);
  return "  " + name + gap + wrapped(text, indent, columns, indent);
}

std::string section(const std::string& title, const std::vector<const CLI::Option*>& options, int columns) {
  std::string out;
  for (const CLI::Option* o : options)
    out += row(o->get_positional() ? o->get_name(true) : signature_of(*o), description_of(*o), columns);
  return out.empty() ? out : "\n" + title + ":\n" + out;
}

std::string commands_text(const CLI::App& command, int columns) {
  std::string out, group;
  for (const CLI::App* sub : commands_of(command)) {
    if (sub->get_group() != group) out += fmt::format("\n{}:\n", group = sub->get_group());
    out += row(sub->get_name(), sub->get_description(), columns);
  }
  return out;
}

/// "left|right", "FILE", "N"; empty for a flag. Choices that are no part of a line are for the description.
std::string values_of(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return "";
  const std::string type = option.get_type_name(), name = type.substr(0, type.find(":{"));
  constexpr std::size_t kPartOfALine = 40;
  const std::string choices = fmt::format("{}", fmt::join(choices_of(option), "|"));
  if (name == "TEXT") return choices.empty() || choices.size() > kPartOfALine ? "NAME" : choices;
  if (name.starts_with("TEXT:")) return name.substr(5);
  return name == "FLOAT" || name == "INT" || name == "UINT" ? "N" : name;
}

}  // namespace

int help_columns() {
  winsize size{};
  const char* columns = std::getenv("COLUMNS");
  const bool terminal = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return std::clamp(terminal ? size.ws_col : columns != nullptr ? std::atoi(columns) : 80, kFewestColumns, kMostColumns);
}

std::string help_text(const CLI::App& command, int columns, bool all) {
  std::string out = wrapped(command.get_description(), 0, columns) + "\nUsage: " + wrapped(usage_of(command), 7, columns, 7);
  out += section("Arguments", options_of(command, true), columns);
  out += commands_text(command, columns);
  out += section("Options", options_of(command, false), columns);
  const auto parameters = parameters_of(command);
  if (all && !parameters.empty()) out += "\nParameters of --set:\n";
  if (all)
    for (const auto& [name, text] : parameters) out += row(name, text, columns);
  return out + footer_text(command.get_footer(), columns);
}

std::string name_of(const CLI::App& command) {
  if (command.get_parent() == nullptr) return "";
  const std::string parent = name_of(*command.get_parent());
  return parent.empty() ? command.get_name() : parent + " " + command.get_name();
}

std::vector<const CLI::App*> commands_of(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App* sub) { return !sub->get_group().empty(); });
}

std::vector<const CLI::Option*> options_of(const CLI::App& command, bool positional) {
  return command.get_options(
      [&](const CLI::Option* o) { return !o->get_group().empty() && o->get_positional() == positional; });
}

std::string usage_of(const CLI::App& command) {
  const std::string name = name_of(command);
  std::string out = "duoptic" + (name.empty() ? "" : " " + name);
  if (!commands_of(command).empty()) return out + " COMMAND ...";
  out += " [OPTIONS]";
  for (const CLI::Option* o : options_of(command, true)) {
    const std::string word = o->get_name(true) + (o->get_items_expected_max() > 1 ? " ..." : "");
    out += o->get_required() ? " " + word : " [" + word + "]";
  }
  return out;
}

std::string signature_of(const CLI::Option& option) {
  std::string out;
  for (const std::string& name : option.get_snames()) out += (out.empty() ? "-" : ", -") + name;
  for (const std::string& name : option.get_lnames()) out += (out.empty() ? "--" : ", --") + name;
  const std::string values = values_of(option);
  return values.empty() ? out : out + " " + values;
}

std::string description_of(const CLI::Option& option) {
  std::string out = option.get_description();
  if (!option.get_positional() && option.get_required()) out += " (required)";
  if (!option.get_default_str().empty()) out += " [" + option.get_default_str() + "]";
  return out;
}

std::vector<std::string> choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find(":{");
  std::vector<std::string> out;
  if (begin == std::string::npos) return out;
  std::istringstream list(type.substr(begin + 2, type.find('}', begin) - begin - 2));
  for (std::string word; std::getline(list, word, ',');) out.push_back(word.substr(0, word.find("->")));
  return out;
}

std::vector<std::pair<std::string, std::string>> parameters_of(const CLI::App& command) {
  std::vector<std::pair<std::string, std::string>> out;
  if (command.get_option_no_throw("--set") == nullptr) return out;
  for (const std::string& matcher : matcher_names())
    if (const auto parameters = matcher_parameters(matcher, "default"))
      for (const ParameterInfo& p : *parameters)
        out.emplace_back(fmt::format("{}: {}", matcher, p.name),
                         fmt::format("{}..{}{}{}: {} [{}]", p.min, p.max, p.unit.empty() ? "" : " ", p.unit, p.help, p.value));
  return out;
}

std::vector<Paragraph> paragraphs_of(const std::string& text) {
  std::vector<Paragraph> out;
  std::istringstream lines(text);
  bool flows = false;
  for (std::string line; std::getline(lines, line);) {
    const bool example = line.starts_with("  ");
    if (example && !out.empty() && out.back().text.ends_with('\\')) {
      line = "  " + out.back().text.substr(0, out.back().text.size() - 1) + line.substr(line.find_first_not_of(' '));
      out.pop_back();
    }
    if (example) {
      const std::size_t gap = line.find("   ", line.find_first_not_of(' '));
      out.push_back({true, line.substr(2, gap == std::string::npos ? gap : gap - 2),
                     gap == std::string::npos ? "" : line.substr(line.find_first_not_of(' ', gap))});
    } else if (flows && !line.empty()) {
      out.back().text += " " + line;
    } else if (!line.empty()) {
      out.push_back({false, line, ""});
    }
    flows = !example && !line.empty();
  }
  return out;
}

}  // namespace duo::app
