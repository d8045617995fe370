// SPDX-License-Identifier: Apache-2.0
// The features viewloom asks of a Vulkan device, as one table that both checks and enables them.
#pragma once

#include <string>
#include <vector>

#include "gpu/vulkan.h"

namespace viewloom {

using FeatureChain =
    vk::StructureChain<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan11Features,
                       vk::PhysicalDeviceVulkan12Features, vk::PhysicalDeviceVulkan13Features>;

// Descriptors are pushed with each dispatch.
inline constexpr const char* kRequiredExtension = VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME;

// Exactly the required features switched on, ready for vkCreateDevice.
FeatureChain requiredFeatures();
// Features that the device lacks, by the names of the Vulkan specification; empty = it will do.
std::vector<std::string> missingFeatures(const vk::raii::PhysicalDevice& device);

}  // namespace viewloom
