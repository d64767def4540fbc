// A list of matchers: the one place from which engines and registry take what can be chosen, so that none can forget one.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/parameter.h"
#include "core/pool.h"
#include "duoptic/engine.h"
#include "matchers/match.h"

namespace duo {

/// A matcher that was chosen by its name, with its parameters.
template <class Matcher>
struct Chosen {
  typename Matcher::Params params;
};

/// Each of `Matchers` has
///   kName, kPresets, kParameters   what it is called by
///   kMaxDisparity                  most disparities that it searches
///   kTellsConfidence               whether it fills Match::confidence
///   kTakesColor, kFills            whether it needs GrayPair's colours, and fills Match::filled
///   Params, params(preset, overrides) -> Result<Params>
///   Ref(params, setup), with match(pair, match, timer)                plain loops: the definition
///   Simd(pool, params, setup), with match(pair, match, timer, rows)   the same bits in `rows`; others may be none
///   Vulkan, with make(device, params, setup) and record(recorder, input, output)
template <class... Matchers>
struct MatcherList {
  using Choice = std::variant<Chosen<Matchers>...>;
  using Ref = std::optional<std::variant<typename Matchers::Ref...>>;
  using Simd = std::optional<std::variant<typename Matchers::Simd...>>;
  using Vulkan = std::optional<std::variant<typename Matchers::Vulkan...>>;

  static std::vector<std::string> names() { return {std::string(Matchers::kName)...}; }

  /// Empty for an unknown matcher.
  static std::vector<std::string> presets(std::string_view name) {
    std::vector<std::string> out;
    ((name == Matchers::kName ? out.assign(Matchers::kPresets.begin(), Matchers::kPresets.end()) : void()), ...);
    return out;
  }

  /// Errors  unknown matcher or preset, with the known ones
  static Result<std::vector<ParameterInfo>> parameters(std::string_view name, std::string_view preset) {
    return by_name<std::vector<ParameterInfo>>("list parameters", name, [&]<class M>(M) -> Result<std::vector<ParameterInfo>> {
      DUO_TRY_ASSIGN(const auto params, M::params(preset, {}));
      std::vector<ParameterInfo> out;
      for (const auto& p : M::kParameters)
        out.push_back({p.name, p.unit, p.help, double(params.*p.member), double(p.min), double(p.max)});
      return out;
    });
  }

  /// What an engine's setup asks for.
  ///
  /// Errors  unknown matcher, preset or parameter; a value out of range; more disparities than it searches; confidence of a
  ///         matcher that tells none
  static Result<Choice> choose(const Setup& setup) {
    return by_name<Choice>("prepare the engine", setup.matcher, [&]<class M>(M) -> Result<Choice> {
      if (setup.max_disparity > M::kMaxDisparity)
        return Error{ErrorCode::kBadInput,
                     fmt::format("prepare the engine: matcher {} searches at most {} disparities, not {}; lower it, or choose "
                                 "matcher {}",
                                 M::kName, M::kMaxDisparity, setup.max_disparity,
                                 names_of({(Matchers::kMaxDisparity >= setup.max_disparity)...}))};
      DUO_TRY_ASSIGN(auto params, M::params(setup.preset, setup.parameters));
      if (setup.wants.confidence && !M::kTellsConfidence)
        return Error{ErrorCode::kBadInput,
                     fmt::format("prepare the engine: matcher {} does not say how sure it is; choose matcher {}, or do not ask "
                                 "for confidence",
                                 M::kName, names_of({Matchers::kTellsConfidence...}))};
      return Choice{Chosen<M>{std::move(params)}};
    });
  }

  static bool takes_color(const Choice& choice) {
    return std::visit([]<class M>(const Chosen<M>&) { return M::kTakesColor; }, choice);
  }
  static bool fills(const Choice& choice) {
    return std::visit([]<class M>(const Chosen<M>&) { return M::kFills; }, choice);
  }

  static void make(const Choice& choice, const MatchSetup& setup, Ref& out) {
    std::visit(
        [&]<class M>(const Chosen<M>& chosen) { out.emplace(std::in_place_type<typename M::Ref>, chosen.params, setup); },
        choice);
  }
  static void make(Pool& pool, const Choice& choice, const MatchSetup& setup, Simd& out) {
    std::visit([&]<class M>(
                   const Chosen<M>& chosen) { out.emplace(std::in_place_type<typename M::Simd>, pool, chosen.params, setup); },
               choice);
  }

 private:
  static std::string names_of(std::initializer_list<bool> which) {
    std::vector<std::string> out = names();
    auto is = which.begin();
    std::erase_if(out, [&](const std::string&) { return !*is++; });
    return fmt::format("{}", fmt::join(out, " or "));
  }

  /// f of the matcher with that name.
  template <class T, class F>
  static Result<T> by_name(std::string_view tried, std::string_view name, F&& f) {
    std::optional<Result<T>> out;
    ((name == Matchers::kName ? void(out.emplace(f(Matchers{}))) : void()), ...);
    if (out) return *std::move(out);
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: no matcher is called \"{}\"; choose one of: {}", tried, name, fmt::join(names(), ", "))};
  }
};

}  // namespace duo
