#include "vulkan/recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "vulkan/timer.h"

namespace duo::vk {
namespace {

constexpr VkPipelineStageFlags2 kStages =
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
constexpr VkAccessFlags2 kWrites = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT;
constexpr VkAccessFlags2 kReads =
    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT;
constexpr std::uint32_t kSetsPerPool = 32, kBuffersPerSet = 8;
constexpr int kMostGroups = 65535;  // along each axis: what every device takes

}  // namespace

Result<Recorder> Recorder::make(Device& device) {
  Recorder out(device);
  auto pool_info = structure<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
  pool_info.queueFamilyIndex = device.queue_family();
  DUO_TRY_ASSIGN(out.command_pool_, OwnedCommandPool::make(device, pool_info, "making a command pool"));

  auto info = structure<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
  info.commandPool = out.command_pool_.get();
  info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  info.commandBufferCount = 1;
  if (const VkResult r = device.fn().vkAllocateCommandBuffers(device.handle(), &info, &out.commands_); r != VK_SUCCESS)
    return device.error("making a command buffer", r);
  return out;
}

Recorder::~Recorder() {
  if (command_pool_.get() != VK_NULL_HANDLE && last_ != 0) (void)device_->wait(last_);
}

void Recorder::begin(Timer* timer) {
  timer_ = timer;
  if (!device_->finished(last_)) {
    failed_ = device_->error("recording anew", VK_NOT_READY);
    return;
  }
  sets_.clear();
  descriptor_pools_.clear();
  unordered_.clear();
  failed_ = {};
  const auto info = structure<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
  VkResult r = device_->fn().vkResetCommandPool(device_->handle(), command_pool_.get(), 0);
  if (r == VK_SUCCESS) r = device_->fn().vkBeginCommandBuffer(commands_, &info);
  if (r != VK_SUCCESS) {
    failed_ = device_->error("starting a recording", r);
    return;
  }
  barrier(kStages, kReads | kWrites);  // submissions of one queue overlap unless told otherwise
  if (timer_ != nullptr) timer_->start(*this);
}

void Recorder::stage(const char* name) {
  if (timer_ != nullptr) timer_->stage(*this, name);
}

bool Recorder::bind(const Kernel& kernel, std::span<const std::byte> push, std::span<const Use> uses,
                    std::span<const Use> ordered) {
  DUO_CHECK(static_cast<int>(uses.size()) == kernel.buffers() && push.size() == kernel.push_bytes());
  if (!failed_) return false;
  const VkDescriptorSet set = set_for(kernel, uses);
  if (!failed_) return false;
  order(ordered);
  const DeviceFunctions& fn = device_->fn();
  fn.vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.pipeline());
  fn.vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.layout(), 0, 1, &set, 0, nullptr);
  fn.vkCmdPushConstants(commands_, kernel.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, static_cast<std::uint32_t>(push.size()),
                        push.data());
  return true;
}

void Recorder::dispatch_bytes(const Kernel& kernel, std::span<const std::byte> push, std::span<const Use> uses, Size groups) {
  DUO_CHECK(!groups.empty());
  if (failed_ && std::max(groups.width, groups.height) > kMostGroups)
    failed_ = Error{ErrorCode::kUnsupported, fmt::format("recording {}x{} workgroups: at most {} along a side fit: use smaller "
                                                         "pictures or a CPU engine",
                                                         groups.width, groups.height, kMostGroups)};
  if (bind(kernel, push, uses, uses))
    device_->fn().vkCmdDispatch(commands_, static_cast<std::uint32_t>(groups.width), static_cast<std::uint32_t>(groups.height),
                                1);
}

void Recorder::dispatch_indirect_bytes(const Kernel& kernel, std::span<const std::byte> push, std::span<const Use> uses,
                                       const Buffer& groups, std::size_t offset) {
  DUO_CHECK(offset % 4 == 0 && offset + 12 <= groups.bytes());
  std::vector<Use> ordered(uses.begin(), uses.end());
  ordered.push_back(reads(groups));
  if (bind(kernel, push, uses, ordered)) device_->fn().vkCmdDispatchIndirect(commands_, groups.handle(), offset);
}

void Recorder::fill(const Buffer& dst, std::uint32_t word) {
  if (!failed_) return;
  const Use uses[] = {writes(dst)};
  order(uses);
  device_->fn().vkCmdFillBuffer(commands_, dst.handle(), 0, VK_WHOLE_SIZE, word);
}

void Recorder::copy(const Buffer& src, const Buffer& dst, std::size_t bytes) {
  DUO_CHECK(bytes <= src.bytes() && bytes <= dst.bytes());
  if (!failed_) return;
  const Use uses[] = {{src.handle(), false}, {dst.handle(), true}};
  order(uses);
  const VkBufferCopy all{0, 0, bytes};
  device_->fn().vkCmdCopyBuffer(commands_, src.handle(), dst.handle(), 1, &all);
}

Result<void> Recorder::end() {
  DUO_TRY(failed_);
  barrier(VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
  if (const VkResult r = device_->fn().vkEndCommandBuffer(commands_); r != VK_SUCCESS)
    failed_ = device_->error("ending a recording", r);
  return failed_;
}

Result<Ticket> Recorder::submit() {
  DUO_TRY(failed_);
  if (!device_->finished(last_)) return device_->error("submitting a recording again", VK_NOT_READY);
  DUO_TRY_ASSIGN(last_, device_->submit(commands_));
  return last_;
}

Result<void> Recorder::run(std::int64_t timeout_ns) {
  DUO_TRY_ASSIGN(const Ticket ticket, submit());
  return device_->wait(ticket, timeout_ns);
}

// One barrier orders everything recorded before it, so that only the uses since the last one have to be looked at.
void Recorder::order(std::span<const Use> uses) {
  const auto conflicts = [&](const Use& use) {
    return std::any_of(unordered_.begin(), unordered_.end(),
                       [&](const Use& earlier) { return earlier.buffer == use.buffer && (earlier.writes || use.writes); });
  };
  if (std::any_of(uses.begin(), uses.end(), conflicts)) {
    barrier(kStages, kReads | kWrites);
    unordered_.clear();
  }
  unordered_.insert(unordered_.end(), uses.begin(), uses.end());
}

void Recorder::barrier(VkPipelineStageFlags2 until, VkAccessFlags2 access) {
  auto memory = structure<VkMemoryBarrier2>(VK_STRUCTURE_TYPE_MEMORY_BARRIER_2);
  memory.srcStageMask = kStages;
  memory.srcAccessMask = kWrites;
  memory.dstStageMask = until;
  memory.dstAccessMask = access;
  auto info = structure<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &memory;
  device_->fn().vkCmdPipelineBarrier2(commands_, &info);
}

VkDescriptorSet Recorder::set_for(const Kernel& kernel, std::span<const Use> uses) {
  std::vector<VkBuffer> buffers;
  for (const Use& use : uses) buffers.push_back(use.buffer);
  for (const Set& set : sets_)
    if (set.layout == kernel.set_layout() && set.buffers == buffers) return set.handle;

  auto set = allocate_set(kernel.set_layout());
  if (!set) {
    failed_ = set.error();
    return VK_NULL_HANDLE;
  }
  std::vector<VkDescriptorBufferInfo> infos;
  for (VkBuffer buffer : buffers) infos.push_back({buffer, 0, VK_WHOLE_SIZE});
  auto write = structure<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
  write.dstSet = *set;
  write.descriptorCount = static_cast<std::uint32_t>(infos.size());  // runs on from binding 0 over the following ones
  write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  write.pBufferInfo = infos.data();
  device_->fn().vkUpdateDescriptorSets(device_->handle(), 1, &write, 0, nullptr);
  sets_.push_back({kernel.set_layout(), std::move(buffers), *set});
  return *set;
}

Result<Buffer> make_filled(Device& device, const std::string& name, std::span<const std::byte> bytes) {
  DUO_TRY_ASSIGN(Buffer out, Buffer::make(device, name, bytes.size(), Memory::kDevice));
  DUO_TRY_ASSIGN(const Buffer staging, Buffer::make(device, name + " staging", bytes.size(), Memory::kUpload));
  std::memcpy(staging.mapped().data(), bytes.data(), bytes.size());
  DUO_TRY_ASSIGN(Recorder recorder, Recorder::make(device));
  recorder.begin();
  recorder.copy(staging, out, bytes.size());
  DUO_TRY(recorder.end());
  DUO_TRY(recorder.run());
  return out;
}

Result<VkDescriptorSet> Recorder::allocate_set(VkDescriptorSetLayout layout) {
  if (sets_.size() == descriptor_pools_.size() * kSetsPerPool) {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kSetsPerPool * kBuffersPerSet};
    auto info = structure<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    info.maxSets = kSetsPerPool;
    info.poolSizeCount = 1;
    info.pPoolSizes = &size;
    DUO_TRY_ASSIGN(OwnedSetPool pool, OwnedSetPool::make(*device_, info, "making a descriptor pool"));
    descriptor_pools_.push_back(std::move(pool));
  }
  auto info = structure<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
  info.descriptorPool = descriptor_pools_.back().get();
  info.descriptorSetCount = 1;
  info.pSetLayouts = &layout;
  VkDescriptorSet set = VK_NULL_HANDLE;
  if (const VkResult r = device_->fn().vkAllocateDescriptorSets(device_->handle(), &info, &set); r != VK_SUCCESS)
    return device_->error("making a descriptor set", r);
  return set;
}

}  // namespace duo::vk
