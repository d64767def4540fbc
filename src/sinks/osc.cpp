#include <fmt/format.h>

#include <deque>
#include <utility>

#include "duoptic/sink.h"
#include "sinks/osc_target.h"

namespace duo {
namespace {

class Osc final : public Sink {
 public:
  Osc(OscTarget target, Axes axes) : target_(std::move(target)), axes_from_rig_(axes_from_rig(axes)) {}

  Result<void> write(const TrackedFrame& frame) override {
    constexpr std::size_t kMost = 32'000;  // bytes: half of what a datagram holds, and more than any person takes
    OscBundle bundle = begun(frame);
    Paths paths;  // liblo keeps the pointers until the bundle is sent
    for (const Person& person : frame.people) {
      if (lo_bundle_length(bundle.get()) > kMost) {
        target_.send(bundle);
        bundle = begun(frame);
      }
      const std::string path = fmt::format("/duoptic/person/{}/", person.id);
      for (std::size_t j = 0; j < person.count(); ++j)
        add(person.joints[j], path + std::string(person.skeleton->joints[j].name), paths, bundle);
      for (const bool left : {true, false})
        if (const auto pinch = pinch_of(person, left ? Side::kLeft : Side::kRight))
          add(*pinch, path + (left ? "left_pinch" : "right_pinch"), paths, bundle);
    }
    target_.send(bundle);
    return {};
  }
  bool instant() const override { return true; }
  std::int64_t dropped() const override { return target_.dropped(); }
  Result<void> finish() override { return {}; }

 private:
  using Paths = std::deque<std::string>;

  static OscBundle begun(const TrackedFrame& frame) {
    OscBundle bundle = new_bundle();
    lo_message head = lo_message_new();
    lo_message_add_int32(head, static_cast<std::int32_t>(frame.number));
    lo_message_add_float(head, static_cast<float>(frame.t_s));
    lo_bundle_add_message(bundle.get(), "/duoptic/frame", head);
    return bundle;
  }
  static void add(const Pinch& pinch, const std::string& path, Paths& paths, const OscBundle& bundle) {
    lo_message message = lo_message_new();
    lo_message_add_float(message, static_cast<float>(pinch.distance_m));
    lo_message_add_float(message, static_cast<float>(pinch.sigma_m));
    lo_bundle_add_message(bundle.get(), paths.emplace_back(path).c_str(), message);
  }
  /// Its place unless it is lost, and always its state: 2 seen, 1 inferred, 0 lost.
  void add(const Joint& joint, const std::string& path, Paths& paths, const OscBundle& bundle) const {
    if (joint.state != JointState::kLost) {
      const Vec3 p_m = axes_from_rig_ * joint.p_in_rig_m;
      lo_message place = lo_message_new();
      for (const double v_m : {p_m.x, p_m.y, p_m.z}) lo_message_add_float(place, static_cast<float>(v_m));
      lo_bundle_add_message(bundle.get(), paths.emplace_back(path).c_str(), place);
    }
    lo_message state = lo_message_new();
    lo_message_add_int32(state, 2 - static_cast<int>(joint.state));
    lo_message_add_float(state, static_cast<float>(joint.sigma_m()));
    lo_message_add_float(state, static_cast<float>(joint.confidence));
    lo_bundle_add_message(bundle.get(), paths.emplace_back(path + "/state").c_str(), state);
  }

  OscTarget target_;
  Mat3 axes_from_rig_;
};

}  // namespace

Result<std::unique_ptr<Sink>> make_osc(const std::string& target, Axes axes) {
  DUO_TRY_ASSIGN(OscTarget opened, OscTarget::open(target));
  return std::unique_ptr<Sink>(std::make_unique<Osc>(std::move(opened), axes));
}

}  // namespace duo
