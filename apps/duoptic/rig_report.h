// What is known of a rig, for people and as JSON.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "duoptic/pipeline.h"
#include "duoptic/rig_health.h"

namespace duo::app {

/// "640x480, focal 555.6 and 551.8 px, 126.8 mm apart, right camera turned by tilt -0.45, pan -0.70, roll 0.55 degrees".
std::string describe(const Rig& rig);
nlohmann::json to_json(const Rig& rig);

/// Three lines: points, rows, pose.
std::string describe(const SceneHealth& health);
nlohmann::json to_json(const SceneHealth& health);

/// What the pairs of a run say of its rig: null until they were judged.
nlohmann::json to_json(const std::optional<RigFit>& fit);

/// The option --strict: what a run does about a rig that does not fit.
void add_strict_option(CLI::App& app, RigCheck& check);
/// Pipeline::rig_news() as a warning; nothing where there are none.
void say_rig_news(const CLI::App& app, const Pipeline& pipeline);

/// Now, as Rig::date has it.
std::string date_now();

/// The worst of all.
RigVerdict overall(const std::vector<RigDoubt>& doubts, const SceneHealth* scene);

}  // namespace duo::app
