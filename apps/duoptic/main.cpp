// duoptic: the command-line tool. Each subcommand has its own file; here they meet the command line and their errors an exit.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "duoptic/interrupt.h"
#include "duoptic/source.h"
#include "help.h"

namespace duo::app {

Exit exit_of(const Error& error) {
  switch (error.code) {
    case ErrorCode::kWriteFailed:
      return Exit::kOutput;
    case ErrorCode::kDeviceLost:
    case ErrorCode::kExhausted:
      return Exit::kUnexpected;
    case ErrorCode::kBadInput:
    case ErrorCode::kNotFound:
    case ErrorCode::kUnsupported:
      return Exit::kInput;
  }
  return Exit::kUnexpected;
}

void print_json(const nlohmann::json& json) {
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

void put_on_stderr(const std::string& text) { std::fputs(text.c_str(), stderr); }

Error stopped(const std::string& before) {
  return {ErrorCode::kBadInput, fmt::format("stopped before {}; nothing was written", before)};
}

void say(const CLI::App& app, const std::string& line) { put_on_stderr(fmt::format("duoptic {}: {}\n", name_of(app), line)); }

namespace {

constexpr char kFooter[] =
    "duoptic COMMAND --help tells more; --help-all also the parameters of the matchers.\n\n"
    "Exit codes: 0 done; 1 unexpected; 2 unknown or impossible option; 3 input cut short, the results of its whole\n"
    "frames are written; 4 an input cannot be used; 5 an output could not be written; 130 and 143 ended by Ctrl-C and "
    "SIGTERM,\n"
    "the results of whole frames are written.\n\n"
    "Try it:\n"
    "  duoptic demo             a synthetic room, with its accuracy and speed on this machine\n"
    "  duoptic view synthetic   a rendered person, tracked in a window";

/// The words after the program's name: "help X" is "X --help", and nothing at all asks for help.
std::vector<std::string> words_of(int argc, char** argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (!words.empty() && words[0] != "help") return words;
  if (!words.empty()) words.erase(words.begin());
  words.emplace_back("--help");
  return words;
}

/// Files that are opened must not become what messages are written to. Who closed stdout wants nothing on it: a write fails.
void occupy_standard_streams() {
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(fd, F_GETFD) < 0) static_cast<void>(open("/dev/null", fd == STDERR_FILENO ? O_WRONLY : O_RDONLY));
}

/// Printed whole, or exit code 5.
int print(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return 0;
  put_on_stderr("duoptic: cannot write to stdout\n");
  return static_cast<int>(Exit::kOutput);
}

/// One line on stderr, with --json also as JSON on stdout.
int fail(const std::string& command, std::string what, Exit exit, bool json) {
  for (char& c : what)
    if (c == '\n') c = ' ';
  put_on_stderr(fmt::format("duoptic{}{}: {}\n", command.empty() ? "" : " ", command, what));
  const nlohmann::json error = {{"error", {{"exit", static_cast<int>(exit)}, {"what", what}}}};
  if (json) std::fputs((error.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n").c_str(), stdout);
  return static_cast<int>(exit);
}

/// Understood after the subcommand's name, too.
void add_limit_option(CLI::App& app) {
  const auto limit = [](double megapixels) { limit_pictures(static_cast<std::int64_t>(megapixels * 1e6)); };
  app.add_option_function<double>(
         "--max-megapixels", limit,
         "Pictures of files and streams with more are refused before they are decoded; of every command")
      ->type_name("N")
      ->check(within(0.001, 300.0))
      ->default_str(fmt::format("{:.0f}", static_cast<double>(kMostPixels) * 1e-6));
  const std::function<void(CLI::App&)> pass_on = [&](CLI::App& command) {
    for (CLI::App* sub : command.get_subcommands({})) {
      sub->fallthrough();
      pass_on(*sub);
    }
  };
  pass_on(app);
}

int run(const std::vector<std::string>& words) {
  CLI::App app("Two webcams as a depth camera and 3D motion tracker.", "duoptic");
  app.require_subcommand(1);
  app.footer(kFooter);
  app.set_help_flag("-h,--help", "Print this help and end");
  app.set_help_all_flag("--help-all", "Print the parameters of the matchers, too");
  app.set_version_flag("--version", "duoptic " DUO_VERSION, "Print the version and end");
  app.formatter_fn([](const CLI::App* command, const std::string&, CLI::AppFormatMode mode) {
    return help_text(*command, help_columns(), mode == CLI::AppFormatMode::All);
  });
  std::vector<Command> commands;
#define DUO_ADD(name, title) commands.push_back(name::add(app)), commands.back().app->group(title);
  DUO_COMMANDS(DUO_ADD)
#undef DUO_ADD
  add_limit_option(app);
  const auto chosen = [&]() -> const Command* {
    for (const Command& command : commands)
      if (command.app->parsed()) return &command;
    return nullptr;
  };
  const auto name = [&] { return chosen() != nullptr ? chosen()->app->get_name() : std::string(); };
  const bool json = std::find(words.begin(), words.end(), "--json") != words.end();
  if (const std::string unknown = unknown_word(app, words); !unknown.empty())
    return fail("", unknown + " (duoptic help lists the commands, duoptic help COMMAND their options)", Exit::kUsage, json);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    Interrupt::listen();
    const Result<Exit> exit = chosen()->run();
    if (Interrupt::exit_code() != 0) {
      put_on_stderr(exit ? "" : fmt::format("duoptic {}: {}\n", name(), exit.error().what));
      return std::fflush(stdout), Interrupt::exit_code();
    }
    if (!exit) return fail(name(), exit.error().what, exit_of(exit.error()), json);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
      return fail(name(), "cannot write to stdout", Exit::kOutput, false);
    return static_cast<int>(*exit);
  } catch (const CLI::ParseError& error) {
    if (error.get_name() == "CallForVersion") return print(fmt::format("{}\n", error.what()));
    if (error.get_exit_code() == 0)
      return print(app.help("", error.get_name() == "CallForAllHelp" ? CLI::AppFormatMode::All : CLI::AppFormatMode::Normal));
    return fail(name(), fmt::format("{} (see duoptic {} --help)", error.what(), name()), Exit::kUsage, json);
  } catch (const std::bad_alloc&) {
    return fail(name(), "out of memory; smaller pictures or a smaller --max-disparity need less", Exit::kUnexpected, json);
  } catch (const std::exception& error) {
    return fail(name(), error.what(), Exit::kUnexpected, json);
  }
}

}  // namespace
}  // namespace duo::app

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a full quota then fails the write, which is reported like a full disk
  std::signal(SIGPIPE, SIG_IGN);  // as does a pipe that nobody reads any more
  duo::app::occupy_standard_streams();
  try {
    return duo::app::run(duo::app::words_of(argc, argv));
  } catch (const std::bad_alloc&) {
    std::fputs("duoptic: out of memory\n", stderr);
    return static_cast<int>(duo::app::Exit::kUnexpected);
  }
}
