#include "vulkan/kernel.h"

#include <fmt/format.h>

#include <vector>

#include "core/check.h"

namespace duo::vk {

Result<Kernel> Kernel::make(const Device& device, const KernelSource& source) {
  DUO_CHECK(source.push_bytes <= 128);
  const std::string tried = fmt::format("making kernel \"{}\"", source.name);
  const DeviceFunctions& fn = device.fn();
  Kernel out;
  out.buffers_ = source.buffers;
  out.push_bytes_ = source.push_bytes;

  std::vector<VkDescriptorSetLayoutBinding> bindings(static_cast<std::size_t>(source.buffers));
  for (std::size_t i = 0; i < bindings.size(); ++i) {
    bindings[i].binding = static_cast<std::uint32_t>(i);
    bindings[i].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    bindings[i].descriptorCount = 1;
    bindings[i].stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
  }
  auto set_info = structure<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
  set_info.bindingCount = static_cast<std::uint32_t>(bindings.size());
  set_info.pBindings = bindings.data();
  DUO_TRY_ASSIGN(out.set_layout_, OwnedSetLayout::make(device, set_info, tried));
  const VkDescriptorSetLayout set_layout = out.set_layout_.get();

  const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, static_cast<std::uint32_t>(source.push_bytes)};
  auto layout_info = structure<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
  layout_info.setLayoutCount = 1;
  layout_info.pSetLayouts = &set_layout;
  layout_info.pushConstantRangeCount = source.push_bytes > 0 ? 1 : 0;
  layout_info.pPushConstantRanges = &push;
  DUO_TRY_ASSIGN(out.layout_, OwnedLayout::make(device, layout_info, tried));

  auto shader_info = structure<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
  shader_info.codeSize = source.spirv.size_bytes();
  shader_info.pCode = source.spirv.data();
  DUO_TRY_ASSIGN(const OwnedShader shader, OwnedShader::make(device, shader_info, tried));

  std::vector<VkSpecializationMapEntry> entries;
  for (std::uint32_t i = 0; i < source.constants.size(); ++i) entries.push_back({i, i * 4, 4});
  const VkSpecializationInfo constants{static_cast<std::uint32_t>(entries.size()), entries.data(),
                                       source.constants.size_bytes(), source.constants.data()};
  auto info = structure<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = shader.get();
  info.stage.pName = "main";
  info.stage.pSpecializationInfo = &constants;
  auto subgroup = structure<VkPipelineShaderStageRequiredSubgroupSizeCreateInfo>(
      VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO);
  subgroup.requiredSubgroupSize = static_cast<std::uint32_t>(source.subgroup_size);
  if (source.subgroup_size > 0) {
    info.stage.flags = VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT;
    info.stage.pNext = &subgroup;
  }
  info.layout = out.layout_.get();
  VkPipeline pipeline = VK_NULL_HANDLE;
  if (const VkResult r = fn.vkCreateComputePipelines(device.handle(), device.pipelines(), 1, &info, nullptr, &pipeline);
      r != VK_SUCCESS)
    return device.error(tried, r);
  out.pipeline_ = {device, pipeline};
  device.set_name(pipeline, VK_OBJECT_TYPE_PIPELINE, source.name);
  return out;
}

}  // namespace duo::vk
