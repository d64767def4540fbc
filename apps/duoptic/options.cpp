#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <thread>

#include "command.h"

namespace duo::app {
namespace {

const std::vector<std::pair<std::string, Denoise>> kDenoise = {{"auto", Denoise::kAuto},
                                                               {"none", Denoise::kNone},
                                                               {"median", Denoise::kMedian},
                                                               {"gaussian", Denoise::kGaussian},
                                                               {"both", Denoise::kBoth}};

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

/// Every parameter of every matcher, a line each, from the matchers' own tables; where it would bury the other options, one line.
std::string parameter_help(const CLI::App& app) {
  if (app.get_name() != "depth") return "Overrides one parameter of the preset, see duoptic depth --help; may be repeated";
  std::string text = "Overrides one parameter of the preset; may be repeated:";
  for (const std::string& matcher : matcher_names())
    if (const auto parameters = matcher_parameters(matcher, "default"))
      for (const ParameterInfo& p : *parameters)
        text += fmt::format("\n  {}: {} {}..{}{}{}: {} [{}]", matcher, p.name, p.min, p.max, p.unit.empty() ? "" : " ", p.unit,
                            p.help, p.value);
  return text;
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
  std::vector<std::string> denoise_names;
  for (const auto& [name, value] : kDenoise) denoise_names.push_back(name);
  app.add_option("--engine", engine,
                 "auto: the graphics card if there is one, else simd; ref: plain loops, slow; simd: the CPU's vectors; vulkan: "
                 "the graphics card, "
                 "vulkan:0 or vulkan:NAME: the card of that index or name, see duoptic devices. All give the same bits")
      ->check(known_engine())
      ->capture_default_str();
  app.add_option("--threads", threads, "Number of threads; the result does not depend on it")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  const CLI::Option* method = app.add_option("--matcher", matcher, "Stereo method; without it, the one that has the preset")
                                  ->check(CLI::IsMember(matcher_names()))
                                  ->capture_default_str();
  app.add_option("--preset", preset, preset_help())->capture_default_str();
  app.add_option("--set", set, parameter_help(app))->type_name("NAME=VALUE");
  app.add_option("--denoise", denoise, "Before rectification; auto: gaussian for raw pictures, none for rectified ones")
      ->check(CLI::IsMember(denoise_names))
      ->capture_default_str();
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
  for (const auto& [name, value] : kDenoise)
    if (name == denoise) setup.denoise = value;
  return setup;
}

CLI::Validator above_zero() {
  return {[](std::string& text) {
            double value = 0;
            const char* end = text.data() + text.size();
            const auto [rest, error] = std::from_chars(text.data(), end, value);
            return error == std::errc() && rest == end && std::isfinite(value) && value > 0
                       ? std::string()
                       : fmt::format("'{}' is not a number above 0, like 0.5", text);
          },
          ""};
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
