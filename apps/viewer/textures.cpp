#include "textures.h"

#include <algorithm>

namespace duo::app::view {
namespace {

constexpr std::uint32_t kVertexCode[] = {
#include "spirv/picture.vert.inc"
};
constexpr std::uint32_t kFragmentCode[] = {
#include "spirv/picture.frag.inc"
};

constexpr Use kNew = {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0};
constexpr Use kWritten = {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT};
constexpr Use kDrawn = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                        VK_ACCESS_SHADER_READ_BIT};

template <std::size_t N>
Result<VkShaderModule> shader(const Gpu& gpu, const std::uint32_t (&code)[N]) {
  VkShaderModuleCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  info.codeSize = sizeof(code);
  info.pCode = code;
  VkShaderModule out = VK_NULL_HANDLE;
  DUO_TRY(check(vkCreateShaderModule(gpu.device, &info, nullptr, &out)));
  return out;
}

VkPipelineShaderStageCreateInfo stage_of(VkShaderStageFlagBits stage, VkShaderModule module) {
  VkPipelineShaderStageCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage = stage;
  info.module = module;
  info.pName = "main";
  return info;
}

}  // namespace

Texture::~Texture() {
  if (gpu_ == nullptr) return;
  vkDeviceWaitIdle(gpu_->device);
  vkDestroyImageView(gpu_->device, view_, nullptr);
  vkDestroyImage(gpu_->device, image_, nullptr);
  vkFreeMemory(gpu_->device, memory_, nullptr);
}

Result<std::unique_ptr<Textures>> Textures::open(const Gpu& gpu, VkDescriptorPool pool, VkRenderPass pass) {
  std::unique_ptr<Textures> out(new Textures(gpu));
  DUO_TRY(out->create(pool, pass));
  return out;
}

Textures::~Textures() {
  vkDestroyPipeline(gpu_.device, pipeline_, nullptr);
  vkDestroyPipelineLayout(gpu_.device, layout_, nullptr);
  vkDestroyDescriptorSetLayout(gpu_.device, set_layout_, nullptr);
  vkDestroySampler(gpu_.device, sampler_, nullptr);
}

Result<void> Textures::create(VkDescriptorPool pool, VkRenderPass pass) {
  pool_ = pool;
  VkSamplerCreateInfo sampler = {};
  sampler.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
  sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
  sampler.addressModeU = sampler.addressModeV = sampler.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  DUO_TRY(check(vkCreateSampler(gpu_.device, &sampler, nullptr, &sampler_)));

  const VkDescriptorSetLayoutBinding binding = {0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT,
                                                &sampler_};
  VkDescriptorSetLayoutCreateInfo set = {};
  set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  set.bindingCount = 1;
  set.pBindings = &binding;
  DUO_TRY(check(vkCreateDescriptorSetLayout(gpu_.device, &set, nullptr, &set_layout_)));

  const VkPushConstantRange place = {VK_SHADER_STAGE_VERTEX_BIT, 0, 4 * sizeof(float)};
  VkPipelineLayoutCreateInfo layout = {};
  layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &set_layout_;
  layout.pushConstantRangeCount = 1;
  layout.pPushConstantRanges = &place;
  DUO_TRY(check(vkCreatePipelineLayout(gpu_.device, &layout, nullptr, &layout_)));
  return create_pipeline(pass);
}

Result<void> Textures::create_pipeline(VkRenderPass pass) {
  DUO_TRY_ASSIGN(const VkShaderModule vertex, shader(gpu_, kVertexCode));
  DUO_TRY_ASSIGN(const VkShaderModule fragment, shader(gpu_, kFragmentCode));
  const VkPipelineShaderStageCreateInfo stages[] = {stage_of(VK_SHADER_STAGE_VERTEX_BIT, vertex),
                                                    stage_of(VK_SHADER_STAGE_FRAGMENT_BIT, fragment)};
  VkPipelineVertexInputStateCreateInfo input = {};
  input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
  VkPipelineInputAssemblyStateCreateInfo assembly = {};
  assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
  VkPipelineViewportStateCreateInfo viewport = {};
  viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
  viewport.viewportCount = viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster = {};
  raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
  raster.lineWidth = 1;
  VkPipelineMultisampleStateCreateInfo samples = {};
  samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineColorBlendAttachmentState opaque = {};
  opaque.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT;
  VkPipelineColorBlendStateCreateInfo blend = {};
  blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
  blend.attachmentCount = 1;
  blend.pAttachments = &opaque;
  const VkDynamicState dynamic[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamics = {};
  dynamics.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
  dynamics.dynamicStateCount = 2;
  dynamics.pDynamicStates = dynamic;

  VkGraphicsPipelineCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
  info.stageCount = 2;
  info.pStages = stages;
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamics;
  info.layout = layout_;
  info.renderPass = pass;
  const VkResult made = vkCreateGraphicsPipelines(gpu_.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_);
  vkDestroyShaderModule(gpu_.device, vertex, nullptr);
  vkDestroyShaderModule(gpu_.device, fragment, nullptr);
  return check(made);
}

Result<void> Textures::make_image(Texture& texture, Size size) {
  VkImageCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;
  info.extent = {static_cast<std::uint32_t>(size.width), static_cast<std::uint32_t>(size.height), 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  DUO_TRY(check(vkCreateImage(gpu_.device, &info, nullptr, &texture.image_)));
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(gpu_.device, texture.image_, &needs);
  DUO_TRY_ASSIGN(texture.memory_, gpu_.allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT));
  DUO_TRY(check(vkBindImageMemory(gpu_.device, texture.image_, texture.memory_, 0)));
  VkImageViewCreateInfo view = {};
  view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  view.image = texture.image_;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = info.format;
  view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  DUO_TRY(check(vkCreateImageView(gpu_.device, &view, nullptr, &texture.view_)));
  DUO_TRY_ASSIGN(texture.staging_, HostBuffer::make(gpu_, VkDeviceSize{4} * info.extent.width * info.extent.height,
                                                    VK_BUFFER_USAGE_TRANSFER_SRC_BIT));
  if (texture.set_ == VK_NULL_HANDLE) {
    VkDescriptorSetAllocateInfo allocate = {};
    allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    allocate.descriptorPool = pool_;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &set_layout_;
    DUO_TRY(check(vkAllocateDescriptorSets(gpu_.device, &allocate, &texture.set_)));
  }
  const VkDescriptorImageInfo image = {VK_NULL_HANDLE, texture.view_, kDrawn.layout};
  VkWriteDescriptorSet write = {};
  write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
  write.dstSet = texture.set_;
  write.descriptorCount = 1;
  write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  write.pImageInfo = &image;
  vkUpdateDescriptorSets(gpu_.device, 1, &write, 0, nullptr);
  texture.size_ = size;
  texture.fresh_ = true;
  return {};
}

Result<void> Textures::set(Texture& texture, View<const Rgb8> pixels) {
  if (texture.size_ != pixels.size()) {
    vkDestroyImageView(gpu_.device, texture.view_, nullptr);
    vkDestroyImage(gpu_.device, texture.image_, nullptr);
    vkFreeMemory(gpu_.device, texture.memory_, nullptr);
    texture.gpu_ = &gpu_;
    texture.view_ = VK_NULL_HANDLE;
    texture.image_ = VK_NULL_HANDLE;
    texture.memory_ = VK_NULL_HANDLE;
    texture.size_ = {};
    DUO_TRY(make_image(texture, pixels.size()));
  }
  std::uint8_t* rgba = texture.staging_.data();
  for (int y = 0; y < pixels.height(); ++y) {
    const Rgb8* row = pixels.row(y);
    for (int x = 0; x < pixels.width(); ++x, rgba += 4) {
      rgba[0] = row[x].r;
      rgba[1] = row[x].g;
      rgba[2] = row[x].b;
      rgba[3] = 255;
    }
  }
  if (!texture.changed_) waiting_.push_back(&texture);
  texture.changed_ = true;
  return {};
}

void Textures::draw(ImDrawList& list, const Texture& texture, ImVec2 from, ImVec2 to) {
  if (texture.size_.empty()) return;
  list.AddCallback(draw_quad, &quads_.emplace_back(Quad{this, texture.set_, from, to}));
  list.AddCallback(ImDrawCallback_ResetRenderState, nullptr);
}

void Textures::upload(VkCommandBuffer commands) {
  commands_ = commands;
  for (Texture* texture : waiting_) {
    change_use(commands, texture->image_, texture->fresh_ ? kNew : kDrawn, kWritten);
    VkBufferImageCopy copy = {};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {static_cast<std::uint32_t>(texture->size_.width), static_cast<std::uint32_t>(texture->size_.height), 1};
    vkCmdCopyBufferToImage(commands, texture->staging_.handle(), texture->image_, kWritten.layout, 1, &copy);
    change_use(commands, texture->image_, kWritten, kDrawn);
    texture->fresh_ = texture->changed_ = false;
  }
  waiting_.clear();
}

void Textures::draw_quad(const ImDrawList*, const ImDrawCmd* command) {
  const Quad& quad = *static_cast<const Quad*>(command->UserCallbackData);
  const Textures& self = *quad.textures;
  const ImDrawData& data = *ImGui::GetDrawData();
  const auto to_clip = [&](ImVec2 p) {
    return ImVec2(2 * (p.x - data.DisplayPos.x) / data.DisplaySize.x - 1,
                  2 * (p.y - data.DisplayPos.y) / data.DisplaySize.y - 1);
  };
  const ImVec2 place[] = {to_clip(quad.from), to_clip(quad.to)};
  const auto pixel = [](float at, float origin, float scale, float most) {
    return static_cast<std::int32_t>(std::clamp((at - origin) * scale, 0.0f, most));
  };
  const ImVec2 scale = data.FramebufferScale, most = {data.DisplaySize.x * scale.x, data.DisplaySize.y * scale.y};
  const ImVec4 clip = command->ClipRect;
  const VkOffset2D from = {pixel(clip.x, data.DisplayPos.x, scale.x, most.x),
                           pixel(clip.y, data.DisplayPos.y, scale.y, most.y)},
                   to = {pixel(clip.z, data.DisplayPos.x, scale.x, most.x), pixel(clip.w, data.DisplayPos.y, scale.y, most.y)};
  const VkRect2D scissor = {
      from, {static_cast<std::uint32_t>(std::max(to.x - from.x, 0)), static_cast<std::uint32_t>(std::max(to.y - from.y, 0))}};
  vkCmdBindPipeline(self.commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, self.pipeline_);
  vkCmdBindDescriptorSets(self.commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, self.layout_, 0, 1, &quad.set, 0, nullptr);
  vkCmdSetScissor(self.commands_, 0, 1, &scissor);
  vkCmdPushConstants(self.commands_, self.layout_, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(place), place);
  vkCmdDraw(self.commands_, 4, 1, 0, 0);
}

}  // namespace duo::app::view
