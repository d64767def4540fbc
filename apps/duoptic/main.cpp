// duoptic: the command-line tool. Each subcommand has its own file; here they meet the command line and their errors an exit.
#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "duoptic/source.h"

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

void put_on_stderr(const std::string& text) { std::fputs(text.c_str(), stderr); }

void say(const CLI::App& app, const std::string& line) { put_on_stderr(fmt::format("duoptic {}: {}\n", app.get_name(), line)); }

namespace {

constexpr char kFooter[] =
    "Exit codes: 0 done; 1 unexpected; 2 unknown or impossible option; 3 input cut short, the results of its whole\n"
    "frames are written; 4 an input cannot be used; 5 an output could not be written.\n\n"
    "Try it:  duoptic demo        a synthetic room, with its accuracy and speed on this machine";

bool wants_json(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "--json") == 0) return true;
  return false;
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
  app.add_option_function<double>("--max-megapixels", limit,
                                  "Pictures of files and streams with more are refused before they are decoded")
      ->type_name("N")
      ->check(CLI::Range(0.001, 300.0))
      ->default_str(fmt::format("{:.0f}", static_cast<double>(kMostPixels) * 1e-6));
  const std::function<void(CLI::App&)> pass_on = [&](CLI::App& command) {
    for (CLI::App* sub : command.get_subcommands({})) {
      sub->fallthrough();
      pass_on(*sub);
    }
  };
  pass_on(app);
}

int run(int argc, char** argv) {
  CLI::App app("Two webcams as a depth camera and 3D motion tracker.", "duoptic");
  app.require_subcommand(1);
  app.footer(kFooter);
#define DUO_ADD(name) name::add(app),
  const std::vector<Command> commands = {DUO_COMMANDS(DUO_ADD)};
#undef DUO_ADD
  add_limit_option(app);
  const auto chosen = [&]() -> const Command* {
    for (const Command& command : commands)
      if (command.app->parsed()) return &command;
    return nullptr;
  };
  const auto name = [&] { return chosen() != nullptr ? chosen()->app->get_name() : std::string(); };
  const bool json = wants_json(argc, argv);
  try {
    app.parse(argc, argv);
    const Result<Exit> exit = chosen()->run();
    if (!exit) return fail(name(), exit.error().what, exit_of(exit.error()), json);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
      return fail(name(), "cannot write to stdout", Exit::kOutput, false);
    return static_cast<int>(*exit);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
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
  try {
    return duo::app::run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fputs("duoptic: out of memory\n", stderr);
    return static_cast<int>(duo::app::Exit::kUnexpected);
  }
}
