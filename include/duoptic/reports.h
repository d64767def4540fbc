// What was found, as lines for people and as JSON for programs: what the tool prints. text_of() gives whole lines unless it
// says otherwise, json_of() a document without a line's end.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "duoptic/archive.h"
#include "duoptic/calibrate.h"
#include "duoptic/cameras.h"
#include "duoptic/depth_quality.h"
#include "duoptic/detector.h"
#include "duoptic/devices.h"
#include "duoptic/evaluation.h"
#include "duoptic/recording.h"
#include "duoptic/rig_fit.h"
#include "duoptic/rig_health.h"
#include "duoptic/scene_contest.h"
#include "duoptic/structured_light.h"

namespace [[gnu::visibility("default")]] duo {

// --- Rigs ----------------------------------------------------------------------------------------------------------------

/// "640x480, focal lengths 555.6 and 551.8 px, 126.8 mm apart, right camera turned by tilt -0.45, pan -0.70, roll 0.55
/// degrees", without a line's end.
std::string text_of(const Rig& rig);
std::string json_of(const Rig& rig);
/// Points, rows, pose.
std::string text_of(const SceneHealth& health);
std::string json_of(const SceneHealth& health);
/// What the pairs of a run say of its rig: null until they were judged.
std::string json_of(const std::optional<RigFit>& fit);

struct CalibrationReport {
  const Calibration& calibration;
  const Calibrator& calibrator;
  const RigDescription& description;
  std::string rig_file, report_file;  // that were written
  double square_mm;
};
std::string text_of(const CalibrationReport& report);
std::string json_of(const CalibrationReport& report);

// --- Cameras, recordings, this machine -------------------------------------------------------------------------------------

std::string text_of(std::span<const CameraInfo> cameras, std::span<const CameraPair> pairs, const CameraWish& wish);
std::string json_of(std::span<const CameraInfo> cameras, std::span<const CameraPair> pairs, const CameraWish& wish);
std::string text_of(std::span<const DeviceInfo> devices);
std::string json_of(std::span<const DeviceInfo> devices);
std::string text_of(const RecordingReport& report);
/// `files`: that were exported.
std::string json_of(const RecordingReport& report, const std::string& file, const std::vector<std::string>& files);

// --- People ----------------------------------------------------------------------------------------------------------------

/// One line, see docs/detect.md.
std::string json_of(std::span<const SeenPerson> people);

// --- Accuracy --------------------------------------------------------------------------------------------------------------

/// The table, with its heading.
std::string text_of(std::span<const ClipScore> scores);
/// `rig`: file of the one that took the place of the true one; empty: none.
std::string json_of(std::span<const ClipScore> scores, double jitter_px, const std::string& rig);

/// The first method scene by scene, and the means of all. One method and one scene at least.
std::string text_of(const std::vector<MethodScores>& methods, const std::vector<SceneGroup>& groups);
std::string json_of(const std::vector<MethodScores>& methods, const std::vector<SceneGroup>& groups);

/// All methods on scenes with one fault.
struct FaultScores {
  std::string name;
  std::vector<MethodScores> methods;
};
std::string heading_of_faults(const std::vector<MethodScores>& clean);
/// What the fault adds to `clean`.
std::string text_of(const FaultScores& fault, const std::vector<MethodScores>& clean);
std::string json_of(const std::vector<FaultScores>& faults, const std::vector<MethodScores>& clean);

std::string text_of(const DepthQuality& quality, Window region, bool metric);
std::string json_of(const DepthQuality& quality, Window region, bool metric, const std::optional<RigFit>& fit);

std::string json_of(const LightCode& code, const std::string& folder);
/// `folder`: of the scene.
std::string text_of(const LightTruth& truth, const std::string& folder);
/// What there is to know of it, a line each: rows that disagree, a dark picture.
std::vector<std::string> warnings_of(const LightTruth& truth);
std::string json_of(const LightTruth& truth, std::size_t patterns, std::size_t exposures, const std::string& folder);

// --- Batches ---------------------------------------------------------------------------------------------------------------

/// "3 of 7 done, 1 running, about 2 min left", without a line's end.
std::string line_of(const BatchStatus& status);
std::string text_of(const Batch& batch, const BatchStatus& status);
std::string json_of(const Batch& batch, const BatchStatus& status);

}  // namespace duo
