// SPDX-License-Identifier: Apache-2.0
#include "gpu/device.h"

#include <algorithm>
#include <charconv>
#include <exception>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "base/log.h"
#include "base/str_cat.h"
#include "gpu/device_features.h"
#include "gpu/kernel_cache.h"
#include "gpu/vulkan.h"

namespace viewloom {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

vk::raii::Instance makeInstance(const vk::raii::Context& context, ValidationLog* validation_log) {
  const vk::ApplicationInfo application{.pApplicationName = "viewloomd",
                                        .apiVersion = VK_API_VERSION_1_3};
  if (!validation_log) return {context, {.pApplicationInfo = &application}};

  const auto layers = context.enumerateInstanceLayerProperties();
  const bool installed = std::any_of(layers.begin(), layers.end(), [](const auto& layer) {
    return std::string_view(layer.layerName) == kValidationLayer;
  });
  if (!installed) {
    throw std::runtime_error(
        "Vulkan validation was asked for but its layer is missing: install "
        "vulkan-validationlayers");
  }
  const auto enabled = vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
  const auto messenger = validation_log->messengerCreateInfo();
  const vk::ValidationFeaturesEXT features{.pNext = &messenger,
                                           .enabledValidationFeatureCount = 1,
                                           .pEnabledValidationFeatures = &enabled};
  const char* extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME,
                              VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
  return {context,
          {.pNext = &features,
           .pApplicationInfo = &application,
           .enabledLayerCount = 1,
           .ppEnabledLayerNames = &kValidationLayer,
           .enabledExtensionCount = std::size(extensions),
           .ppEnabledExtensionNames = extensions}};
}

DeviceLimits limitsOf(const vk::raii::PhysicalDevice& device) {
  const auto chain =
      device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties,
                            vk::PhysicalDeviceVulkan13Properties>();
  const vk::PhysicalDeviceLimits& limits =
      chain.get<vk::PhysicalDeviceProperties2>().properties.limits;
  DeviceLimits result{.allocation_bytes_max = std::min(
                          chain.get<vk::PhysicalDeviceVulkan11Properties>().maxMemoryAllocationSize,
                          chain.get<vk::PhysicalDeviceVulkan13Properties>().maxBufferSize),
                      .storage_bytes_max = limits.maxStorageBufferRange,
                      .texel_count_max = limits.maxTexelBufferElements,
                      .push_bytes_max = limits.maxPushConstantsSize,
                      .group_size_max = limits.maxComputeWorkGroupInvocations};
  std::copy_n(limits.maxComputeWorkGroupCount.begin(), 3, result.groups_max);
  const auto memory = device.getMemoryProperties();
  for (uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
    if (memory.memoryHeaps[i].flags & vk::MemoryHeapFlagBits::eDeviceLocal) {
      result.memory_bytes += memory.memoryHeaps[i].size;
    }
  }
  return result;
}

DeviceInfo describe(const vk::raii::PhysicalDevice& device, uint32_t index) {
  const vk::PhysicalDeviceProperties properties = device.getProperties();
  DeviceInfo info;
  info.index = index;
  info.name = properties.deviceName.data();
  info.is_software = properties.deviceType == vk::PhysicalDeviceType::eCpu;
  info.shares_memory = info.is_software;
  info.missing_features = missingFeatures(device);
  if (properties.apiVersion >= VK_API_VERSION_1_3) {
    const auto driver =
        device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>()
            .get<vk::PhysicalDeviceDriverProperties>();
    info.driver = strCat(driver.driverName.data(), ", ", driver.driverInfo.data());
    info.limits = limitsOf(device);
  }
  return info;
}

std::vector<DeviceInfo> describeAll(const std::vector<vk::raii::PhysicalDevice>& devices) {
  std::vector<DeviceInfo> infos;
  infos.reserve(devices.size());
  for (const vk::raii::PhysicalDevice& device : devices) {
    infos.push_back(describe(device, static_cast<uint32_t>(infos.size())));
  }
  return infos;
}

bool isSelected(const DeviceInfo& info, const std::string& select) {
  uint32_t index = 0;
  const char* end = select.data() + select.size();
  if (const auto parsed = std::from_chars(select.data(), end, index);
      parsed.ec == std::errc() && parsed.ptr == end) {
    return info.index == index;
  }
  return absl::StrContains(absl::AsciiStrToLower(info.name), absl::AsciiStrToLower(select));
}

// The index of the device to use.
uint32_t choose(const std::vector<DeviceInfo>& infos, const std::string& select) {
  if (infos.empty()) {
    throw std::runtime_error("no Vulkan device: install a GPU driver or mesa-vulkan-drivers");
  }
  std::optional<uint32_t> best;
  std::string refused;
  for (const DeviceInfo& info : infos) {
    if (!select.empty() && !isSelected(info, select)) continue;
    if (!info.missing_features.empty()) {
      refused += strCat("\n  ", info.index, " ", info.name, " lacks ",
                        absl::StrJoin(info.missing_features, ", "));
    } else if (!best || (infos[*best].is_software && !info.is_software)) {
      best = info.index;
    }
  }
  if (best) return *best;
  if (!refused.empty()) {
    throw std::runtime_error(strCat("no usable Vulkan device; update the driver or choose ",
                                    "another device with --device:", refused));
  }
  const auto name = [](std::string* out, const DeviceInfo& info) {
    *out += strCat("\n  ", info.index, " ", info.name);
  };
  throw std::runtime_error(strCat("no Vulkan device matches \"", select,
                                  "\"; there are:", absl::StrJoin(infos, "", name)));
}

uint32_t computeFamily(const vk::raii::PhysicalDevice& device) {
  const auto families = device.getQueueFamilyProperties();
  for (uint32_t i = 0; i < families.size(); ++i) {
    if (families[i].queueFlags & vk::QueueFlagBits::eCompute) return i;
  }
  throw std::runtime_error("the Vulkan device has no compute queue; choose another with --device");
}

// Each pair of device and driver has a file of its own.
std::string kernelFileName(const vk::raii::PhysicalDevice& device) {
  std::string name = "kernels-";
  for (const uint8_t byte : device.getProperties().pipelineCacheUUID) {
    name += absl::StrFormat("%02x", byte);
  }
  return name;
}

vk::raii::Device makeDevice(const vk::raii::PhysicalDevice& physical_device,
                            uint32_t queue_family) {
  const float priority = 1.0f;
  const vk::DeviceQueueCreateInfo queue{
      .queueFamilyIndex = queue_family, .queueCount = 1, .pQueuePriorities = &priority};
  const FeatureChain features = requiredFeatures();
  return {physical_device,
          {.pNext = &features.get<vk::PhysicalDeviceFeatures2>(),
           .queueCreateInfoCount = 1,
           .pQueueCreateInfos = &queue,
           .enabledExtensionCount = 1,
           .ppEnabledExtensionNames = &kRequiredExtension}};
}

}  // namespace

struct Device::Handles {
  vk::raii::Context context;
  vk::raii::Instance instance;
  vk::raii::DebugUtilsMessengerEXT messenger = nullptr;
  vk::raii::PhysicalDevice physical_device = nullptr;
  vk::raii::Device device = nullptr;
  vk::raii::Queue queue = nullptr;
  vk::raii::PipelineCache pipeline_cache = nullptr;
  std::optional<KernelCache> kernel_cache;

  explicit Handles(ValidationLog* validation_log)
      : instance(makeInstance(context, validation_log)) {
    if (validation_log) messenger = {instance, validation_log->messengerCreateInfo()};
  }
};

Device::Device(const DeviceOptions& options)
    : validation_(options.validation),
      planted_fault_(options.planted_fault),
      handles_(std::make_unique<Handles>(validation_ ? &validation_log_ : nullptr)) {
  const auto devices = handles_->instance.enumeratePhysicalDevices();
  const std::vector<DeviceInfo> infos = describeAll(devices);
  const uint32_t chosen = choose(infos, options.select);
  const vk::raii::PhysicalDevice& physical_device = devices[chosen];
  handles_->physical_device = physical_device;
  info_ = infos[chosen];
  if (options.has_own_memory) info_.shares_memory = false;
  DeviceLimits& limits = info_.limits;
  limits.storage_bytes_max = std::min(limits.storage_bytes_max, options.storage_bytes_max);
  limits.texel_count_max = std::min(limits.texel_count_max, options.texel_count_max);
  queue_family_ = computeFamily(physical_device);
  const auto family = physical_device.getQueueFamilyProperties()[queue_family_];
  timestamp_valid_bits_ = family.timestampValidBits;
  if (timestamp_valid_bits_ > 0) {
    timestamp_period_ns_ = double{physical_device.getProperties().limits.timestampPeriod};
  }
  handles_->device = makeDevice(physical_device, queue_family_);
  handles_->queue = handles_->device.getQueue(queue_family_, 0);
  std::vector<uint8_t> kernels;
  if (!options.kernel_folder.empty() && !info_.is_software) {
    handles_->kernel_cache.emplace(std::filesystem::path(options.kernel_folder) /
                                   kernelFileName(physical_device));
    kernels = handles_->kernel_cache->read();
  }
  handles_->pipeline_cache = {handles_->device,
                              {.initialDataSize = kernels.size(), .pInitialData = kernels.data()}};
}

Device::~Device() {
  try {
    keepKernels();
  } catch (const std::exception& error) {  // the device is lost
    log(LogLevel::kWarning, "compiled kernels are not kept: ", error.what());
  }
}

const vk::raii::PipelineCache& Device::pipelineCache() const {
  return handles_->pipeline_cache;
}

void Device::keepKernels() const {
  if (!handles_->kernel_cache) return;
  std::lock_guard lock(kernel_mutex_);
  handles_->kernel_cache->write(handles_->pipeline_cache.getData());
}

const vk::raii::Device& Device::handle() const {
  return handles_->device;
}

const vk::raii::PhysicalDevice& Device::physicalDevice() const {
  return handles_->physical_device;
}

std::vector<DeviceInfo> Device::listDevices() {
  try {
    const vk::raii::Context context;
    const vk::raii::Instance instance = makeInstance(context, nullptr);
    return describeAll(instance.enumeratePhysicalDevices());
  } catch (const std::runtime_error&) {  // no loader or no driver: nothing to list
    return {};
  }
}

void Device::submit(const vk::SubmitInfo2& submission) const {
  std::lock_guard lock(queue_mutex_);
  handles_->queue.submit2(submission);
}

void Device::setName(vk::ObjectType type, uint64_t handle, const char* name) const {
  if (!validation_) return;
  handles_->device.setDebugUtilsObjectNameEXT(
      {.objectType = type, .objectHandle = handle, .pObjectName = name});
}

}  // namespace viewloom
