// duoptic manual and duoptic completion: the help as pages for man(1) and as a script for bash.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>

#include "duoptic/output_set.h"
#include "help.h"

namespace duo::app::manual {
namespace {

/// "duoptic-eval-clip"
std::string page_of(const CLI::App& command) {
  std::string name = name_of(command);
  std::replace(name.begin(), name.end(), ' ', '-');
  return name.empty() ? "duoptic" : "duoptic-" + name;
}

/// As troff takes it literally.
std::string troff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if (c == '\n')
      out += ' ';
    else if ((c == '.' || c == '\'') && out.empty())
      out += fmt::format("\\&{}", c);
    else
      out += c;
  }
  return out;
}

std::string entry(const std::string& name, const std::string& text) {
  return fmt::format(".TP\n\\fB{}\\fR\n{}\n", troff(name), troff(text));
}

/// In the language of man(7).
std::string page(const CLI::App& command) {
  std::string group,
      out = fmt::format(".TH {0} 1 \"\" \"Duoptic {1}\" \"Duoptic\"\n.SH NAME\n{0} \\- {2}\n.SH SYNOPSIS\n{3}\n",
                        page_of(command), DUO_VERSION, troff(command.get_description()), troff(usage_of(command)));
  for (const CLI::App* sub : commands_of(command)) {
    if (sub->get_group() != group) out += fmt::format(".SH \"{}\"\n", group = sub->get_group());
    out += entry(sub->get_name(), sub->get_description());
  }
  for (const bool positional : {true, false}) {
    const auto options = options_of(command, positional);
    if (!options.empty()) out += positional ? ".SH ARGUMENTS\n" : ".SH OPTIONS\n";
    for (const CLI::Option* o : options) out += entry(positional ? o->get_name(true) : signature_of(*o), description_of(*o));
  }
  const auto parameters = parameters_of(command);
  if (!parameters.empty()) out += ".SH \"PARAMETERS OF \\-\\-set\"\n";
  for (const auto& [name, text] : parameters) out += entry(name, text);
  out += ".SH NOTES\n";
  for (const Paragraph& p : paragraphs_of(command.get_footer()))
    out += !p.example
               ? fmt::format(".PP\n{}\n", troff(p.text))
               : fmt::format(".PP\n.nf\n.RS\n{}{}\n.RE\n.fi\n", troff(p.text), p.note.empty() ? "" : troff("   # " + p.note));
  return out;
}

/// The command and all below it, outermost first.
std::vector<const CLI::App*> all_of(const CLI::App& command) {
  std::vector<const CLI::App*> out = {&command};
  for (const CLI::App* sub : commands_of(command))
    for (const CLI::App* each : all_of(*sub)) out.push_back(each);
  return out;
}

Result<Exit> run(const CLI::App& duoptic, const std::vector<std::string>& words, const std::string& folder) {
  const std::string name = fmt::format("{}", fmt::join(words, " "));
  std::optional<OutputSet> out;
  if (!folder.empty()) {
    DUO_TRY_ASSIGN(OutputSet opened, OutputSet::open(folder));
    out.emplace(std::move(opened));
  }
  for (const CLI::App* command : all_of(duoptic)) {
    if (out) {
      const std::string file = page_of(*command) + ".1";
      std::ofstream to(*out / file);
      if (!(to << page(*command)).flush())
        return Error{ErrorCode::kWriteFailed, fmt::format("cannot write {}/{}", folder, file)};
    } else if (name_of(*command) == name) {
      fmt::print("{}", page(*command));
      return Exit::kOk;
    }
  }
  if (!out) return Error{ErrorCode::kBadInput, fmt::format("no command is called '{}'; duoptic help lists them", name)};
  DUO_TRY(out->publish());
  return Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("manual", "Pages for man(1), in its language, made of the help");
  const auto words = std::make_shared<std::vector<std::string>>();
  const auto folder = std::make_shared<std::string>();
  sub->add_option("COMMAND", *words, "Whose page to print; without it that of duoptic itself");
  sub->add_option("-o,--output", *folder, "Write all pages into a folder, as duoptic.1, duoptic-depth.1 and so on")
      ->type_name("DIR");
  sub->footer("Examples:\n  duoptic manual depth | man -l -\n  duoptic manual eval clip\n  duoptic manual -o man/man1");
  return {sub, [&app, words, folder] { return run(app, *words, *folder); }};
}

}  // namespace duo::app::manual

namespace duo::app::completion {
namespace {

/// Completes commands, options, and the values of options that take one of a few; all else as file names.
std::string script(const CLI::App& duoptic) {
  std::string names, words, values;
  const std::function<void(const CLI::App&)> add = [&](const CLI::App& command) {
    std::vector<std::string> known;
    for (const CLI::App* sub : commands_of(command)) known.push_back(sub->get_name());
    for (const CLI::Option* option : options_of(command, false))
      for (const std::string& name : option->get_lnames()) {
        known.push_back("--" + name);
        if (const auto choices = choices_of(*option); !choices.empty())
          values += fmt::format("    '{}:--{}') words='{}' ;;\n", name_of(command), name, fmt::join(choices, " "));
      }
    names += fmt::format("{}'{}'", names.empty() ? "" : "|", name_of(command));
    words += fmt::format("      '{}') words='{}' ;;\n", name_of(command), fmt::join(known, " "));
    for (const CLI::App* sub : commands_of(command)) add(*sub);
  };
  add(duoptic);
  return fmt::format(R"(# Completion for bash of the program duoptic, made by duoptic completion bash.
_duoptic() {{
  local current="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD - 1]}}" command='' words='' i
  for ((i = 1; i < COMP_CWORD; i++)); do
    case "${{command:+$command }}${{COMP_WORDS[i]}}" in
      {}) command="${{command:+$command }}${{COMP_WORDS[i]}}" ;;
    esac
  done
  case "$command:$before" in
{}    *) case "$command" in
{}    esac ;;
  esac
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}}
complete -o default -F _duoptic duoptic
)",
                     names, values, words);
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("completion", "A script that completes commands and options in a shell");
  sub->add_option("SHELL", "The shell")->check(CLI::IsMember({"bash"}))->required();
  sub->footer("Example:\n  source <(duoptic completion bash)");
  return {sub, [&app]() -> Result<Exit> {
            fmt::print("{}", script(app));
            return Exit::kOk;
          }};
}

}  // namespace duo::app::completion
