// SPDX-License-Identifier: Apache-2.0
#include "gpu/device_features.h"

#include <algorithm>
#include <string_view>

namespace viewloom {
namespace {

struct RequiredFeature {
  const char* name;
  vk::Bool32& (*in)(FeatureChain& chain);
};

template <auto Member, typename Struct>
vk::Bool32& field(FeatureChain& chain) {
  return chain.get<Struct>().*Member;
}

using Features11 = vk::PhysicalDeviceVulkan11Features;
using Features12 = vk::PhysicalDeviceVulkan12Features;
using Features13 = vk::PhysicalDeviceVulkan13Features;

constexpr RequiredFeature kRequired[] = {
    {"storageBuffer8BitAccess", field<&Features12::storageBuffer8BitAccess, Features12>},
    {"shaderInt8", field<&Features12::shaderInt8, Features12>},
    {"scalarBlockLayout", field<&Features12::scalarBlockLayout, Features12>},
    {"timelineSemaphore", field<&Features12::timelineSemaphore, Features12>},
    {"bufferDeviceAddress", field<&Features12::bufferDeviceAddress, Features12>},
    {"synchronization2", field<&Features13::synchronization2, Features13>},
    {"maintenance4", field<&Features13::maintenance4, Features13>},
};

// Compute kernels add up over subgroups; Vulkan has a property for that, not a feature.
bool hasSubgroupSums(const vk::raii::PhysicalDevice& device) {
  using Properties11 = vk::PhysicalDeviceVulkan11Properties;
  const auto chain = device.getProperties2<vk::PhysicalDeviceProperties2, Properties11>();
  const Properties11& offered = chain.get<Properties11>();
  return (offered.subgroupSupportedStages & vk::ShaderStageFlagBits::eCompute) &&
         (offered.subgroupSupportedOperations & vk::SubgroupFeatureFlagBits::eArithmetic);
}

}  // namespace

FeatureChain requiredFeatures() {
  FeatureChain chain;
  for (const RequiredFeature& feature : kRequired) feature.in(chain) = VK_TRUE;
  return chain;
}

std::vector<std::string> missingFeatures(const vk::raii::PhysicalDevice& device) {
  if (device.getProperties().apiVersion < VK_API_VERSION_1_3) return {"Vulkan 1.3"};
  auto offered =
      device.getFeatures2<vk::PhysicalDeviceFeatures2, Features11, Features12, Features13>();
  std::vector<std::string> missing;
  const auto extensions = device.enumerateDeviceExtensionProperties();
  const auto is_required = [](const vk::ExtensionProperties& extension) {
    return std::string_view(extension.extensionName) == kRequiredExtension;
  };
  if (std::none_of(extensions.begin(), extensions.end(), is_required)) {
    missing.emplace_back(kRequiredExtension);
  }
  for (const RequiredFeature& feature : kRequired) {
    if (feature.in(offered) != VK_TRUE) missing.emplace_back(feature.name);
  }
  if (!hasSubgroupSums(device)) missing.emplace_back("subgroup arithmetic in compute shaders");
  return missing;
}

}  // namespace viewloom
