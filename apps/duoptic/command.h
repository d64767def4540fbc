// What the subcommands share: how each one is declared, how it ends, and the options of the engine.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "duoptic/engine.h"
#include "duoptic/result.h"
#include "duoptic/window.h"

namespace duo::app {

/// Exit codes; stable, and below the 124 and more that shells and timeout(1) use.
enum class Exit : int {
  kOk = 0,
  kUnexpected = 1,  // our fault, or the machine's: out of memory, no such instruction, …
  kUsage = 2,       // unknown or impossible option
  kCut = 3,         // the input was cut short; the results of its whole frames are there
  kInput = 4,       // an input cannot be used
  kOutput = 5,      // an output could not be written whole
};

Exit exit_of(const Error& error);

struct Command {
  CLI::App* app;
  std::function<Result<Exit>()> run;
};

/// The options that say which engine runs with which matcher.
struct EngineOptions {
  std::string engine = "auto";
  int threads;  // all that the machine has
  std::string matcher = "sgm", preset = "default";
  std::vector<std::string> set;  // NAME=VALUE
  Denoise denoise = Denoise::kAuto;
  bool fill = false;

  EngineOptions();
  /// Declares them; names and values are checked while the command line is read.
  void add_to(CLI::App& app);
  /// The setup without size, rig and wants.
  Setup setup() const;

 private:
  void check() const;
};

/// --size WxH, like 640x480; a usage error where it is none.
CLI::Option* add_size_option(CLI::App& app, Size& size, const char* help);

/// An option whose values are those of an enumeration, by their names in its order.
template <class Enum, std::size_t N>
CLI::Option* add_choice_option(CLI::App& app, const char* option, Enum& value, const std::array<std::string_view, N>& names,
                               const char* help) {
  const auto take = [&value, &names](const std::string& name) {
    value = static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  return app.add_option_function<std::string>(option, take, help)
      ->check(CLI::IsMember(std::vector<std::string>(names.begin(), names.end())))
      ->default_str(std::string(names[static_cast<std::size_t>(value)]));
}

/// An option that gives a rectangle of the picture: X,Y,W,H; a usage error where it is none.
CLI::Option* add_window_option(CLI::App& app, const char* name, const char* help, const std::function<void(Window)>& take);

/// For options that hold a number above 0, finite.
CLI::Validator above_zero();

/// For options that hold a number in a range; NaN is in none.
CLI::Validator within(double least, double most);
CLI::Validator within(int least, int most);
CLI::Validator within(std::int64_t least, std::int64_t most);

/// Whether what is said of `output` may be printed: not where that goes to stdout itself.
///
/// Errors  thrown as usage: --json would go there, too
bool may_print(const std::string& output, bool json);

/// What a command ends with that a signal stops before it has a result.
Error stopped(const std::string& before);

/// On stdout, with a line's end. Names of files may be no UTF-8.
void print_json(const nlohmann::json& json);

/// Writes to stderr. A stderr that is closed or full changes nothing: fmt::print() would throw.
void put_on_stderr(const std::string& text);

/// Prints a warning or a note of progress as one line on stderr.
void say(const CLI::App& app, const std::string& line);

}  // namespace duo::app
