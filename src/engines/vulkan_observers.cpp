#include "engines/vulkan_observers.h"

#include "core/clock.h"
#include "engines/vulkan_maps.h"

namespace duo::vk {

Result<Observers> Observers::make(Device& device, Size size, int slots, bool time_stages) {
  Observers out(device);
  out.time_stages_ = time_stages;
  DUO_TRY_ASSIGN(ObserveJoints joints, ObserveJoints::make(device, size));
  out.joints_ = std::make_unique<ObserveJoints>(std::move(joints));
  DUO_TRY(make_map<std::uint8_t>(device, "left for a click", size, out.down_.left, Memory::kDownload));
  DUO_TRY(make_map<Rgb8>(device, "color for a click", size, out.down_.color, Memory::kDownload));
  DUO_TRY(make_map<std::uint16_t>(device, "disparity for a click", size, out.down_.d_q4, Memory::kDownload));
  DUO_TRY_ASSIGN(Recorder points_up, Recorder::make(device));
  out.points_up_.emplace(std::move(points_up));
  out.points_up_->begin();
  out.joints_->record_points(*out.points_up_);
  DUO_TRY(out.points_up_->end());
  out.slots_.resize(static_cast<std::size_t>(slots));
  for (Slot& slot : out.slots_) {
    DUO_TRY(out.make_slot(slot, size));
    DUO_TRY(out.record(slot, size));
  }
  return out;
}

Result<void> Observers::make_slot(Slot& slot, Size size) {
  constexpr int kParts = 12;
  DUO_TRY(make_map<std::uint8_t>(*device_, "left observed", size, slot.maps.left));
  DUO_TRY(make_map<Rgb8>(*device_, "color observed", size, slot.maps.color));
  DUO_TRY(make_map<std::uint16_t>(*device_, "disparity observed", size, slot.maps.d_q4));
  DUO_TRY_ASSIGN(slot.timer, Timer::make(*device_, kParts));
  for (auto* recorder : {&slot.observe, &slot.fetch}) {
    DUO_TRY_ASSIGN(Recorder made, Recorder::make(*device_));
    recorder->emplace(std::move(made));
  }
  return {};
}

Result<void> Observers::record(Slot& slot, Size size) {
  slot.observe->begin(time_stages_ ? &slot.timer : nullptr);
  joints_->record(*slot.observe, {whole<Rgb8>(slot.maps.color, size), whole<std::uint8_t>(slot.maps.left, size),
                                  whole<std::uint16_t>(slot.maps.d_q4, size)});
  DUO_TRY(slot.observe->end());
  slot.fetch->begin();
  slot.fetch->copy(slot.maps.left, down_.left, down_.left.bytes());
  slot.fetch->copy(slot.maps.color, down_.color, down_.color.bytes());
  slot.fetch->copy(slot.maps.d_q4, down_.d_q4, down_.d_q4.bytes());
  return slot.fetch->end();
}

Result<void> Observers::observe(int slot, const Expectation& expected, Observation& seen) {
  Slot& at = slots_[static_cast<std::size_t>(slot)];
  if (joints_->expect(expected)) DUO_TRY(points_up_->run(device_->patience_ns()));
  DUO_TRY(at.observe->run(device_->patience_ns()));
  joints_->read(seen);
  seen.stages = {};
  if (!time_stages_) return {};
  DUO_TRY_ASSIGN(const auto times, at.timer.read());
  for (const Timer::Time& t : times) add_time(seen.stages, t.stage, static_cast<std::int64_t>(t.ns), 0);
  return {};
}

Result<void> Observers::fetch(int slot, Frame& frame) {
  DUO_TRY(slots_[static_cast<std::size_t>(slot)].fetch->run(device_->patience_ns()));
  unpack(down_.left, frame.left);
  unpack(down_.color, frame.color);
  unpack(down_.d_q4, frame.disparity.d_q4);
  return {};
}

}  // namespace duo::vk
