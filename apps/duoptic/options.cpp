#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <thread>

#include "command.h"
#include "duoptic/stdout.h"

namespace duo::app {
namespace {

constexpr std::array<std::string_view, 6> kDenoiseNames = {"auto", "none", "median", "gaussian", "both", "diffusion"};

CLI::Validator known_engine() {
  return {[](std::string& name) {
            // Devices are opened once, when they are needed.
            if (name == "vulkan" || name.starts_with("vulkan:")) return std::string();
            const auto engine = make_engine(name, 1);
            return engine ? std::string() : engine.error().what;
          },
          "auto|ref|simd|vulkan[:DEVICE]"};
}

std::pair<std::string, double> parse_parameter(const std::string& text) {
  const std::size_t equals = text.find('=');
  double value = 0;
  const char* begin = text.data() + std::min(equals, text.size() - 1) + 1;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(begin, end, value);
  if (equals == std::string::npos || error != std::errc() || rest != end)
    throw CLI::ValidationError("--set", fmt::format("'{}' is not NAME=VALUE with a number", text));
  return {text.substr(0, equals), value};
}

std::string preset_help() {
  std::string text = "A named set of the matcher's parameters;";
  for (const std::string& matcher : matcher_names())
    text += fmt::format(" {}: {};", matcher, fmt::join(matcher_presets(matcher), ", "));
  text.pop_back();
  return text;
}

/// The first matcher that has this preset; `otherwise` when none has, which check() then says.
std::string matcher_with(const std::string& preset, const std::string& otherwise) {
  for (const std::string& matcher : matcher_names()) {
    const auto presets = matcher_presets(matcher);
    if (std::find(presets.begin(), presets.end(), preset) != presets.end()) return matcher;
  }
  return otherwise;
}

}  // namespace

EngineOptions::EngineOptions() : threads(std::max(1, static_cast<int>(std::thread::hardware_concurrency()))) {}

void EngineOptions::add_to(CLI::App& app) {
  app.add_option("--engine", engine,
                 "auto: the graphics card if there is one, else simd; ref: plain loops, slow; simd: the CPU's vectors; vulkan: "
                 "the graphics card, "
                 "vulkan:0 or vulkan:NAME: the card of that index or name, see duoptic devices. All give the same bits")
      ->check(known_engine())
      ->capture_default_str();
  app.add_option("--threads", threads, "Number of threads; the result does not depend on it")
      ->check(within(1, 256))
      ->capture_default_str();
  const CLI::Option* method = app.add_option("--matcher", matcher, "Stereo method; without it, the one that has the preset")
                                  ->check(CLI::IsMember(matcher_names()))
                                  ->capture_default_str();
  app.add_option("--preset", preset, preset_help())->capture_default_str();
  app.add_option("--set", set, "Overrides one parameter of the preset; may be repeated; --help-all lists them")
      ->type_name("NAME=VALUE");
  add_choice_option(app, "--denoise", denoise, kDenoiseNames,
                    "Before rectification; auto: gaussian for raw pictures, none for rectified ones");
  app.add_flag("--fill", fill, "Fill holes: flat walls by their plane, all else by the surface behind");
  app.parse_complete_callback([this, method] {
    if (method->count() == 0) matcher = matcher_with(preset, matcher);
    check();
  });
}

void EngineOptions::check() const {
  const auto infos = matcher_parameters(matcher, preset);
  if (!infos) throw CLI::ValidationError("--preset", infos.error().what);
  for (const std::string& text : set) {
    const auto [name, value] = parse_parameter(text);
    const auto info = std::find_if(infos->begin(), infos->end(), [&n = name](const ParameterInfo& i) { return i.name == n; });
    if (info == infos->end()) {
      std::string known;
      for (const ParameterInfo& i : *infos) known += (known.empty() ? "" : ", ") + i.name;
      throw CLI::ValidationError("--set", fmt::format("no parameter '{}'; there are: {}", name, known));
    }
    if (!(value >= info->min && value <= info->max))
      throw CLI::ValidationError("--set", fmt::format("{} must be in {} .. {} {}", name, info->min, info->max, info->unit));
  }
}

Setup EngineOptions::setup() const {
  Setup setup;
  setup.matcher = matcher;
  setup.preset = preset;
  for (const std::string& text : set) setup.parameters.push_back(parse_parameter(text));
  setup.fill = fill;
  setup.denoise = denoise;
  return setup;
}

namespace {

template <class T>
std::optional<T> number_in(const std::string& text) {
  T value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + (text.starts_with('+') ? 1 : 0), end, value);
  return error == std::errc() && rest == end ? std::optional(value) : std::nullopt;
}

template <class T>
CLI::Validator in_range(T least, T most, const char* kind) {
  return {[=](std::string& text) {
            const auto value = number_in<T>(text);
            return value && *value >= least && *value <= most
                       ? std::string()
                       : fmt::format("'{}' is not a {} from {} to {}", text, kind, least, most);
          },
          ""};
}

}  // namespace

CLI::Validator within(double least, double most) { return in_range(least, most, "number"); }
CLI::Validator within(int least, int most) { return in_range(least, most, "whole number"); }
CLI::Validator within(std::int64_t least, std::int64_t most) { return in_range(least, most, "whole number"); }

CLI::Validator above_zero() {
  return {[](std::string& text) {
            const auto value = number_in<double>(text);
            return value && std::isfinite(*value) && *value > 0 ? std::string()
                                                                : fmt::format("'{}' is not a number above 0, like 0.5", text);
          },
          ""};
}

namespace {

/// "X,Y,W,H" as columns [X, X + W) of rows [Y, Y + H).
Window parse_window(const char* option, const std::string& text) {
  int values[4] = {}, n = 0;
  const char *at = text.data(), *const end = at + text.size();
  for (; n < 4; ++n) {
    const auto [rest, error] = std::from_chars(at, end, values[n]);
    if (error != std::errc() || (rest != end && *rest != ',') || (rest == end) != (n == 3)) break;
    at = rest + (rest != end);
  }
  const Window window{values[0], values[1], values[2], values[3]};
  if (n < 4 || window.empty() || values[0] < 0 || values[1] < 0 ||
      std::max({values[0], values[1], values[2], values[3]}) > 1 << 20)
    throw CLI::ValidationError(option, fmt::format("'{}' is not X,Y,W,H with a corner >= 0 and a size >= 1 px", text));
  return window;
}

}  // namespace

CLI::Option* add_window_option(CLI::App& app, const char* name, const char* help, const std::function<void(Window)>& take) {
  const auto parse = [=](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) take(parse_window(name, text));
  };
  return app.add_option_function<std::vector<std::string>>(name, parse, help)->type_name("X,Y,W,H")->allow_extra_args(false);
}

bool may_print(const std::string& output, bool json) {
  if (is_stdout(output) && json) throw CLI::ValidationError("--json", "both it and --output would go to stdout");
  return !is_stdout(output);
}

CLI::Option* add_size_option(CLI::App& app, Size& size, const char* help) {
  const auto parse = [&size](const std::string& text) {
    char rest = 0;
    if (std::sscanf(text.c_str(), "%5dx%5d%c", &size.width, &size.height, &rest) != 2 || size.empty())
      throw CLI::ValidationError("--size", fmt::format("'{}' is not WIDTHxHEIGHT, like 640x480", text));
  };
  return app.add_option_function<std::string>("--size", parse, help)->type_name("WxH");
}

}  // namespace duo::app
