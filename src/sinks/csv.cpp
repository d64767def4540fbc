#include <fmt/format.h>

#include <utility>

#include "core/file.h"
#include "duoptic/sink.h"
#include "sinks/joint_text.h"

namespace duo {
namespace {

class Csv final : public Sink {
 public:
  Csv(PartialFile file, Axes axes) : file_(std::move(file)), axes_from_rig_(axes_from_rig(axes)) {}

  Result<void> begin() {
    std::string row = "frame,t_s,arm";
    for (const std::string_view joint : kJointNames)
      row += fmt::format(",{0}_x_m,{0}_y_m,{0}_z_m,{0}_state,{0}_sigma_m,{0}_confidence", joint);
    return file_.write(row + "\n");
  }

  Result<void> write(const TrackedFrame& frame) override {
    std::string rows;
    for (std::size_t arm = 0; arm < frame.arms.size(); ++arm) {
      rows += fmt::format("{},{},{}", frame.number, number(frame.t_s, 6), arm + 1);
      for (const Keypoint& joint : frame.arms[arm].joints) rows += cells(joint);
      rows += "\n";
    }
    return file_.write(rows);
  }
  Result<void> finish() override { return file_.publish(); }

 private:
  std::string cells(const Keypoint& joint) const {
    std::string out = ",,,";
    if (joint.state != JointState::kLost) {
      const Vec3 p_m = axes_from_rig_ * joint.p_in_rig_m;
      out = fmt::format(",{},{},{}", number(p_m.x, 4, ""), number(p_m.y, 4, ""), number(p_m.z, 4, ""));
    }
    return out +
           fmt::format(",{},{},{}", state_text(joint.state), number(joint.sigma_m, 4, ""), number(joint.confidence, 3, ""));
  }

  PartialFile file_;
  Mat3 axes_from_rig_;
};

}  // namespace

Result<std::unique_ptr<Sink>> make_csv(const std::filesystem::path& path, Axes axes) {
  DUO_TRY_ASSIGN(PartialFile file, PartialFile::open(path));
  auto sink = std::make_unique<Csv>(std::move(file), axes);
  DUO_TRY(sink->begin());
  return std::unique_ptr<Sink>(std::move(sink));
}

}  // namespace duo
