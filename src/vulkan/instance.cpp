#include "vulkan/instance.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace duo::vk {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr std::uint32_t kStorageBuffers = 8;  // of one kernel

const char* type_name(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "software";
    default:
      return "other";
  }
}

std::string version_name(std::uint32_t v) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(v), VK_API_VERSION_MINOR(v), VK_API_VERSION_PATCH(v));
}

bool layer_installed(PFN_vkEnumerateInstanceLayerProperties enumerate) {
  std::uint32_t count = 0;
  if (enumerate(&count, nullptr) != VK_SUCCESS) return false;
  std::vector<VkLayerProperties> layers(count);
  if (enumerate(&count, layers.data()) < 0) return false;
  return std::any_of(layers.begin(), layers.end(),
                     [](const auto& layer) { return std::strcmp(layer.layerName, kValidationLayer) == 0; });
}

}  // namespace

std::string describe(VkResult result) {
  switch (result) {
    case VK_TIMEOUT:
      return "not finished in time";
    case VK_NOT_READY:
      return "not finished yet";
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      return "out of memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      return "out of device memory";
    case VK_ERROR_DEVICE_LOST:
      return "the device was lost";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
      return "no Vulkan driver";
    case VK_ERROR_INITIALIZATION_FAILED:
      return "the driver did not start";
    default:
      return fmt::format("Vulkan error {}", static_cast<int>(result));
  }
}

Result<std::shared_ptr<Instance>> Instance::open(Validation validation, const char* library) {
  void* loader = dlopen(library, RTLD_NOW | RTLD_LOCAL);
  if (loader == nullptr)
    return Error{ErrorCode::kNotFound,
                 fmt::format("opening Vulkan: {}: install libvulkan1 and a driver, or use a CPU engine", dlerror())};
  const auto get = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(loader, "vkGetInstanceProcAddr"));
  if (get == nullptr)
    return Error{ErrorCode::kUnsupported,
                 fmt::format("opening Vulkan: {} is not a Vulkan loader: install libvulkan1", library)};
  std::shared_ptr<Instance> instance(new Instance);
  DUO_TRY(instance->create(validation, get));
  return instance;
}

Result<void> Instance::create(Validation validation, PFN_vkGetInstanceProcAddr get) {
  const auto create = reinterpret_cast<PFN_vkCreateInstance>(get(nullptr, "vkCreateInstance"));
  const auto layers =
      reinterpret_cast<PFN_vkEnumerateInstanceLayerProperties>(get(nullptr, "vkEnumerateInstanceLayerProperties"));
  if (create == nullptr || layers == nullptr || get(nullptr, "vkEnumerateInstanceVersion") == nullptr)
    return Error{ErrorCode::kUnsupported, "opening Vulkan: the loader knows only Vulkan 1.0: install a newer libvulkan1"};

  const bool validate = validation != Validation::kOff;
  if (validate && !layer_installed(layers))
    return Error{ErrorCode::kNotFound,
                 fmt::format("opening Vulkan: validation asked for, but {} is not installed: install vulkan-validationlayers",
                             kValidationLayer)};

  auto listen = structure<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
  listen.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  listen.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  listen.pfnUserCallback = on_message;
  listen.pUserData = this;
  const VkValidationFeatureEnableEXT also = validation == Validation::kGpuAssisted
                                                ? VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT
                                                : VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  auto features = structure<VkValidationFeaturesEXT>(VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, &listen);
  features.enabledValidationFeatureCount = 1;
  features.pEnabledValidationFeatures = &also;

  auto application = structure<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
  application.pApplicationName = "duoptic";
  application.apiVersion = VK_API_VERSION_1_3;
  auto info = structure<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
  info.pApplicationInfo = &application;
  const char* const extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  if (validate) {
    info.pNext = &features;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kValidationLayer;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = &extension;
  }
  VkInstance handle = VK_NULL_HANDLE;
  if (const VkResult r = create(&info, nullptr, &handle); r != VK_SUCCESS)
    return Error{ErrorCode::kNotFound,
                 fmt::format("opening Vulkan: {}: install a driver (mesa-vulkan-drivers), or use a CPU engine", describe(r))};
  handle_ = handle;

#define DUO_VK_LOAD(name) fn_.name = reinterpret_cast<PFN_##name>(get(handle_, #name));
  DUO_VK_INSTANCE_FUNCTIONS(DUO_VK_LOAD)
  if (!validate) return {};
  DUO_VK_DEBUG_FUNCTIONS(DUO_VK_LOAD)
#undef DUO_VK_LOAD
  if (const VkResult r = fn_.vkCreateDebugUtilsMessengerEXT(handle_, &listen, nullptr, &messenger_); r != VK_SUCCESS)
    return Error{ErrorCode::kUnsupported, fmt::format("opening Vulkan: listening to validation: {}", describe(r))};
  return {};
}

Instance::~Instance() {
  if (messenger_ != VK_NULL_HANDLE) fn_.vkDestroyDebugUtilsMessengerEXT(handle_, messenger_, nullptr);
  if (handle_ != VK_NULL_HANDLE) fn_.vkDestroyInstance(handle_, nullptr);
}

Result<std::vector<PhysicalDevice>> Instance::devices() const {
  std::uint32_t count = 0;
  VkResult r = fn_.vkEnumeratePhysicalDevices(handle_, &count, nullptr);
  std::vector<VkPhysicalDevice> handles(count);
  if (r == VK_SUCCESS && count > 0) r = fn_.vkEnumeratePhysicalDevices(handle_, &count, handles.data());
  if (r < 0 || count == 0)
    return Error{ErrorCode::kNotFound, fmt::format("listing Vulkan devices: {}: install a driver, or use a CPU engine",
                                                   r < 0 ? describe(r) : "there is none")};
  handles.resize(count);  // a device may have gone between the two calls
  std::vector<PhysicalDevice> devices;
  for (VkPhysicalDevice handle : handles) devices.push_back(inspect(handle));
  return devices;
}

PhysicalDevice Instance::inspect(VkPhysicalDevice handle) const {
  VkPhysicalDeviceProperties basic;
  fn_.vkGetPhysicalDeviceProperties(handle, &basic);
  PhysicalDevice out;
  out.handle = handle;
  out.info.name = basic.deviceName;
  for (const std::uint8_t byte : basic.pipelineCacheUUID) out.pipelines_id += fmt::format("{:02x}", byte);
  out.info.type = type_name(basic.deviceType);
  out.info.api_version = version_name(basic.apiVersion);
  const auto need = [&](bool there, const char* what) {
    if (!there) out.info.lacks.emplace_back(what);
  };
  need(basic.apiVersion >= VK_API_VERSION_1_3, "Vulkan 1.3");
  if (basic.apiVersion < VK_API_VERSION_1_3) return out;  // what follows cannot be asked of it

  auto sizes = structure<VkPhysicalDeviceVulkan13Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES);
  auto driver = structure<VkPhysicalDeviceVulkan12Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES, &sizes);
  auto subgroup =
      structure<VkPhysicalDeviceVulkan11Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES, &driver);
  auto properties = structure<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &subgroup);
  fn_.vkGetPhysicalDeviceProperties2(handle, &properties);
  out.info.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
  out.info.subgroup_size = static_cast<int>(subgroup.subgroupSize);
  out.least_subgroup_size = static_cast<int>(sizes.minSubgroupSize);
  out.most_subgroup_size = static_cast<int>(sizes.maxSubgroupSize);

  constexpr VkSubgroupFeatureFlags kSubgroup =
      VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
  need((subgroup.subgroupSupportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0 &&
           (subgroup.subgroupSupportedOperations & kSubgroup) == kSubgroup,
       "subgroup arithmetic and shuffle in compute shaders");

  auto f13 = structure<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
  auto f12 = structure<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &f13);
  auto f11 = structure<VkPhysicalDeviceVulkan11Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES, &f12);
  auto features = structure<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &f11);
  fn_.vkGetPhysicalDeviceFeatures2(handle, &features);
  need(features.features.shaderInt64, "shaderInt64");
  need(f12.storageBuffer8BitAccess, "storageBuffer8BitAccess");
  need(f11.storageBuffer16BitAccess, "storageBuffer16BitAccess");
  need(f12.timelineSemaphore, "timelineSemaphore");
  need(f13.synchronization2, "synchronization2");
  need(f13.maintenance4, "maintenance4");
  need(f13.subgroupSizeControl && f13.computeFullSubgroups &&
           (sizes.requiredSubgroupSizeStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0,
       "subgroups of a size that is asked for, and full ones");
  need(basic.limits.maxPerStageDescriptorStorageBuffers >= kStorageBuffers, "8 storage buffers in a shader");

  std::uint32_t count = 0;
  fn_.vkGetPhysicalDeviceQueueFamilyProperties(handle, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  fn_.vkGetPhysicalDeviceQueueFamilyProperties(handle, &count, families.data());
  const auto compute = std::find_if(families.begin(), families.end(),
                                    [](const auto& family) { return (family.queueFlags & VK_QUEUE_COMPUTE_BIT) != 0; });
  need(compute != families.end(), "a compute queue");
  if (compute == families.end()) return out;
  out.queue_family = static_cast<std::uint32_t>(compute - families.begin());
  if (compute->timestampValidBits > 0) {
    out.tick_ns = basic.limits.timestampPeriod;
    out.tick_mask = ~std::uint64_t{0} >> (64 - compute->timestampValidBits);
  }
  return out;
}

VkBool32 Instance::on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                              const VkDebugUtilsMessengerCallbackDataEXT* data, void* instance) {
  auto* self = static_cast<Instance*>(instance);
  const std::lock_guard lock(self->mutex_);
  self->messages_.emplace_back(data->pMessage);
  return VK_FALSE;
}

std::vector<std::string> Instance::messages() const {
  const std::lock_guard lock(mutex_);
  return messages_;
}

}  // namespace duo::vk
