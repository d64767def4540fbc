// Reports inside others.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "core/json_text.h"
#include "duoptic/rig_fit.h"
#include "duoptic/rig_health.h"

namespace duo {

nlohmann::json report_json(const Rig& rig);
nlohmann::json report_json(const SceneHealth& health);
nlohmann::json report_json(const std::optional<RigFit>& fit);

template <class T>
nlohmann::json or_null(const std::optional<T>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

}  // namespace duo
