#include "vulkan/timer.h"

namespace duo::vk {

Result<Timer> Timer::make(const Device& device, int stages) {
  Timer out;
  out.device_ = &device;
  out.capacity_ = static_cast<std::size_t>(stages);
  out.times_.reserve(out.capacity_);
  out.ticks_.resize(out.capacity_ + 1);
  auto info = structure<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = static_cast<std::uint32_t>(stages) + 1;
  DUO_TRY_ASSIGN(out.queries_, OwnedQueries::make(device, info, "making a timer"));
  return out;
}

void Timer::start(Recorder& recorder) {
  times_.clear();
  if (device_->tick_ns() == 0 || !recorder.ok()) return;
  device_->fn().vkCmdResetQueryPool(recorder.commands(), queries_.get(), 0, static_cast<std::uint32_t>(capacity_) + 1);
  stamp(recorder, 0);
}

void Timer::stage(Recorder& recorder, const char* name) {
  DUO_CHECK(times_.size() < capacity_);
  times_.push_back({name, 0});
  stamp(recorder, times_.size());
}

void Timer::stamp(Recorder& recorder, std::size_t index) {
  if (device_->tick_ns() == 0 || !recorder.ok()) return;
  device_->fn().vkCmdWriteTimestamp2(recorder.commands(), VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(),
                                     static_cast<std::uint32_t>(index));
}

Result<std::span<const Timer::Time>> Timer::read() {
  if (device_->tick_ns() == 0) return std::span<const Time>(times_);
  const std::size_t count = times_.size() + 1;
  if (const VkResult r = device_->fn().vkGetQueryPoolResults(device_->handle(), queries_.get(), 0,
                                                             static_cast<std::uint32_t>(count), count * sizeof(ticks_[0]),
                                                             ticks_.data(), sizeof(ticks_[0]), VK_QUERY_RESULT_64_BIT);
      r != VK_SUCCESS)
    return device_->error("reading a timer", r);
  for (std::size_t i = 0; i < times_.size(); ++i) times_[i].ns = device_->elapsed_ns(ticks_[i], ticks_[i + 1]);
  return std::span<const Time>(times_);
}

}  // namespace duo::vk
