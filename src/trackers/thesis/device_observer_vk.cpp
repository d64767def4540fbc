#include "trackers/thesis/device_observer_vk.h"

#include <functional>
#include <utility>

#include "core/clock.h"
#include "vulkan/maps.h"

namespace duo::vk {

Result<std::unique_ptr<VulkanObserver::Recordings>> VulkanObserver::Recordings::make(std::shared_ptr<const FrameMaps> maps) {
  std::unique_ptr<Recordings> out(new Recordings(std::move(maps)));
  Device& device = *out->maps_->device;
  const Size size = out->maps_->size;
  DUO_TRY_ASSIGN(ObserveJoints joints, ObserveJoints::make(device, size));
  out->joints_ = std::make_unique<ObserveJoints>(std::move(joints));
  DUO_TRY(make_map<std::uint8_t>(device, "left for a click", size, out->down_.left, Memory::kDownload));
  DUO_TRY(make_map<Rgb8>(device, "color for a click", size, out->down_.color, Memory::kDownload));
  DUO_TRY(make_map<std::uint16_t>(device, "disparity for a click", size, out->down_.d_q4, Memory::kDownload));
  out->fetched_.left = Image<std::uint8_t>(size);
  out->fetched_.color = Image<Rgb8>(size);
  out->fetched_.disparity.d_q4 = Image<std::uint16_t>(size);
  DUO_TRY_ASSIGN(Recorder points_up, Recorder::make(device));
  out->points_up_.emplace(std::move(points_up));
  out->points_up_->begin();
  out->joints_->record_points(*out->points_up_);
  DUO_TRY(out->points_up_->end());
  out->slots_.resize(out->maps_->slots.size());
  for (std::size_t i = 0; i < out->slots_.size(); ++i) DUO_TRY(out->record(out->maps_->slots[i], out->slots_[i]));
  device.keep_pipelines();
  return out;
}

Result<void> VulkanObserver::Recordings::record(const FrameMaps::Slot& maps, Slot& slot) {
  constexpr int kParts = 12;
  Device& device = *maps_->device;
  const Size size = maps_->size;
  DUO_TRY_ASSIGN(slot.timer, Timer::make(device, kParts));
  for (auto* recorder : {&slot.observe, &slot.fetch}) {
    DUO_TRY_ASSIGN(Recorder made, Recorder::make(device));
    recorder->emplace(std::move(made));
  }
  slot.observe->begin(maps_->time_stages ? &slot.timer : nullptr);
  joints_->record(*slot.observe,
                  {whole<Rgb8>(maps.color, size), whole<std::uint8_t>(maps.left, size), whole<std::uint16_t>(maps.d_q4, size)});
  DUO_TRY(slot.observe->end());
  slot.fetch->begin();
  slot.fetch->copy(maps.left, down_.left, down_.left.bytes());
  slot.fetch->copy(maps.color, down_.color, down_.color.bytes());
  slot.fetch->copy(maps.d_q4, down_.d_q4, down_.d_q4.bytes());
  return slot.fetch->end();
}

Result<void> VulkanObserver::Recordings::observe(int slot, const Expectation& expected, Observation& seen) {
  const std::int64_t patience_ns = maps_->device->patience_ns();
  Slot& at = slots_[static_cast<std::size_t>(slot)];
  if (joints_->expect(expected)) DUO_TRY(points_up_->run(patience_ns));
  DUO_TRY(at.observe->run(patience_ns));
  joints_->read(seen);
  seen.stages = {};
  if (!maps_->time_stages) return {};
  DUO_TRY_ASSIGN(const auto times, at.timer.read());
  for (const Timer::Time& t : times) add_time(seen.stages, t.stage, static_cast<std::int64_t>(t.ns), 0);
  return {};
}

Result<void> VulkanObserver::Recordings::fetch(int slot) {
  DUO_TRY(slots_[static_cast<std::size_t>(slot)].fetch->run(maps_->device->patience_ns()));
  unpack(down_.left, fetched_.left);
  unpack(down_.color, fetched_.color);
  unpack(down_.d_q4, fetched_.disparity.d_q4);
  return {};
}

Result<void> VulkanObserver::use(DeviceMaps& frame, const auto& with) {
  const auto work = [&](const std::shared_ptr<const FrameMaps>& maps, int slot) -> Result<void> {
    if (recordings_ == nullptr || recordings_->of() != maps.get()) {
      recordings_.reset();  // first: there need not be memory for both
      DUO_TRY_ASSIGN(recordings_, Recordings::make(maps));
    }
    return with(*recordings_, slot);
  };
  auto used =
      dynamic_cast<FrameOnDevice&>(frame).use(std::cref(work));  // by reference: a std::function of its own would allocate
  if (!used) recordings_.reset();
  return used;
}

bool VulkanObserver::observe(DeviceMaps& frame, const Expectation& expected, Observation& seen) {
  return use(frame, [&](Recordings& recordings, int slot) { return recordings.observe(slot, expected, seen); }).has_value();
}

Result<const Frame*> VulkanObserver::maps(DeviceMaps& frame) {
  DUO_TRY(use(frame, [](Recordings& recordings, int slot) { return recordings.fetch(slot); }));
  return &recordings_->fetched();
}

}  // namespace duo::vk
