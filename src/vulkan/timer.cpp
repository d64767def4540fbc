#include "vulkan/timer.h"

namespace duo::vk {

Result<Timer> Timer::make(const Device& device, int stages) {
  Timer out;
  out.device_ = &device;
  out.capacity_ = static_cast<std::size_t>(stages);
  auto info = structure<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = static_cast<std::uint32_t>(stages) + 1;
  DUO_TRY_ASSIGN(out.queries_, OwnedQueries::make(device, info, "making a timer"));
  return out;
}

void Timer::start(Recorder& recorder) {
  names_.clear();
  if (device_->tick_ns() == 0 || !recorder.ok()) return;
  device_->fn().vkCmdResetQueryPool(recorder.commands(), queries_.get(), 0, static_cast<std::uint32_t>(capacity_) + 1);
  stamp(recorder, 0);
}

void Timer::stage(Recorder& recorder, std::string name) {
  DUO_CHECK(names_.size() < capacity_);
  names_.push_back(std::move(name));
  stamp(recorder, names_.size());
}

void Timer::stamp(Recorder& recorder, std::size_t index) {
  if (device_->tick_ns() == 0 || !recorder.ok()) return;
  device_->fn().vkCmdWriteTimestamp2(recorder.commands(), VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(),
                                     static_cast<std::uint32_t>(index));
}

Result<std::vector<Timer::Time>> Timer::read() const {
  std::vector<std::uint64_t> ticks(names_.size() + 1);
  if (device_->tick_ns() != 0)
    if (const VkResult r = device_->fn().vkGetQueryPoolResults(
            device_->handle(), queries_.get(), 0, static_cast<std::uint32_t>(ticks.size()), ticks.size() * sizeof(ticks[0]),
            ticks.data(), sizeof(ticks[0]), VK_QUERY_RESULT_64_BIT);
        r != VK_SUCCESS)
      return device_->error("reading a timer", r);
  std::vector<Time> times;
  for (std::size_t i = 0; i < names_.size(); ++i) times.push_back({names_[i], device_->elapsed_ns(ticks[i], ticks[i + 1])});
  return times;
}

}  // namespace duo::vk
