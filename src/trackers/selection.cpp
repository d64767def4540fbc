#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "duoptic/tracker.h"

namespace duo {
namespace {

Error bad_click(std::string why) { return {ErrorCode::kBadInput, std::move(why)}; }

/// The text before '=', and the two numbers behind it.
Result<std::pair<std::string, Click>> parse_click(const std::string& text) {
  const std::string_view all = text;
  const std::size_t equals = std::min(all.find('='), all.size()), comma = std::min(all.find(',', equals), all.size());
  const auto number = [](std::string_view part, double& out) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), out);
    return error == std::errc() && end == part.data() + part.size() && std::isfinite(out);
  };
  Click click;
  if (comma == all.size() || !number(all.substr(equals + 1, comma - equals - 1), click.x_px) ||
      !number(all.substr(comma + 1), click.y_px))
    return bad_click(fmt::format("'{}' is not JOINT=X,Y with two numbers", text));
  return std::pair(text.substr(0, equals), click);
}

}  // namespace

std::string joint_names(std::span<const Skeleton* const> skeletons) {
  std::vector<std::string_view> names;
  for (const Skeleton* skeleton : skeletons)
    for (const JointDef& joint : skeleton->joints) names.push_back(joint.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

Result<std::vector<Selection>> parse_selections(const std::vector<std::string>& texts, const std::string& side,
                                                std::span<const Skeleton* const> skeletons) {
  std::vector<Selection> out;
  const auto with = [](const Selection& selection, JointId joint) {
    return std::any_of(selection.clicks.begin(), selection.clicks.end(), [&](const Click& c) { return c.joint == joint; });
  };
  for (const std::string& text : texts) {
    DUO_TRY_ASSIGN(auto parsed, parse_click(text));
    auto& [name, click] = parsed;
    const auto joint = joint_named(name) ? joint_named(name) : joint_named(side + "_" + name);
    const auto skeleton = std::find_if(skeletons.begin(), skeletons.end(),
                                       [&](const Skeleton* s) { return joint && s->index_of(*joint).has_value(); });
    if (skeleton == skeletons.end())
      return bad_click(fmt::format("no joint '{}'; there are: {}", name, joint_names(skeletons)));
    click.joint = *joint;
    auto selection = std::find_if(out.begin(), out.end(), [&](const Selection& s) { return s.skeleton == *skeleton; });
    if (selection == out.end()) selection = out.insert(out.end(), {*skeleton, {}});
    if (with(*selection, *joint)) return bad_click(fmt::format("{} is given twice", name_of(*joint)));
    selection->clicks.push_back(click);
  }
  for (const Selection& selection : out)
    for (const JointDef& joint : selection.skeleton->joints)
      if (!with(selection, joint.id))
        return bad_click(fmt::format("{} is missing; give JOINT=X,Y of each: {}", joint.name,
                                     joint_names(std::span<const Skeleton* const>(&selection.skeleton, 1))));
  return out;
}

}  // namespace duo
