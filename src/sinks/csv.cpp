#include <fmt/format.h>

#include <utility>

#include "core/file.h"
#include "duoptic/sink.h"
#include "sinks/text_values.h"

namespace duo {
namespace {

class Csv final : public Sink {
 public:
  Csv(PartialFile file, Axes axes) : file_(std::move(file)), axes_from_rig_(axes_from_rig(axes)) {}

  Result<void> begin() { return file_.write("frame,t_s,person,joint,x_m,y_m,z_m,state,sigma_m,confidence\n"); }

  Result<void> write(const TrackedFrame& frame) override {
    std::string rows;
    for (const Person& person : frame.people)
      for (std::size_t j = 0; j < person.count(); ++j)
        rows += fmt::format("{},{},{},{}{}\n", frame.number, number(frame.t_s, 6), person.id, person.skeleton->joints[j].name,
                            cells(person.joints[j]));
    return file_.write(rows);
  }
  Result<void> finish() override { return file_.publish(); }

 private:
  std::string cells(const Joint& joint) const {
    std::string out = ",,,";
    if (joint.state != JointState::kLost) {
      const Vec3 p_m = axes_from_rig_ * joint.p_in_rig_m;
      out = fmt::format(",{},{},{}", number(p_m.x, 4, ""), number(p_m.y, 4, ""), number(p_m.z, 4, ""));
    }
    return out +
           fmt::format(",{},{},{}", state_text(joint.state), number(joint.sigma_m(), 4, ""), number(joint.confidence, 3, ""));
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
