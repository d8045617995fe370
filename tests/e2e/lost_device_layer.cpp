// SPDX-License-Identifier: Apache-2.0
// A Vulkan layer that loses the device: its nth submission, and whatever is submitted or waited for
// after that, ends in VK_ERROR_DEVICE_LOST. n is the environment's VIEWLOOM_TEST_LOST_SUBMISSION.
// The program below it is as it is; of its devices, the newest alone is served.
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <atomic>
#include <cstdlib>
#include <string_view>

namespace {

std::atomic<int> submission_count = 0;
PFN_vkGetInstanceProcAddr next_instance_function = nullptr;
PFN_vkGetDeviceProcAddr next_device_function = nullptr;
PFN_vkQueueSubmit2 next_submit = nullptr;
PFN_vkWaitSemaphores next_wait = nullptr;
PFN_vkQueueWaitIdle next_wait_idle = nullptr;

// The number from 1 of the submission that fails.
int lostSubmission() {
  static const int kNumber = std::atoi(std::getenv("VIEWLOOM_TEST_LOST_SUBMISSION"));
  return kNumber;
}

// The loader's note to this layer in the chain below a create info; it is the layer's to change.
template <typename Link>
Link* findLink(const void* chain, VkStructureType type) {
  for (const void* next = chain; next != nullptr;) {
    auto* const link = static_cast<Link*>(const_cast<void*>(next));
    if (link->sType == type && link->function == VK_LAYER_LINK_INFO) return link;
    next = link->pNext;
  }
  return nullptr;
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info,
                                              const VkAllocationCallbacks* allocator,
                                              VkInstance* instance) {
  auto* const link = findLink<VkLayerInstanceCreateInfo>(
      info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
  if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  next_instance_function = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto create = reinterpret_cast<PFN_vkCreateInstance>(
      next_instance_function(VK_NULL_HANDLE, "vkCreateInstance"));
  return create(info, allocator, instance);
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical_device,
                                            const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* allocator,
                                            VkDevice* device) {
  auto* const link =
      findLink<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
  if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  const auto create = reinterpret_cast<PFN_vkCreateDevice>(
      link->u.pLayerInfo->pfnNextGetInstanceProcAddr(VK_NULL_HANDLE, "vkCreateDevice"));
  next_device_function = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const VkResult result = create(physical_device, info, allocator, device);
  if (result != VK_SUCCESS) return result;
  next_submit =
      reinterpret_cast<PFN_vkQueueSubmit2>(next_device_function(*device, "vkQueueSubmit2"));
  next_wait =
      reinterpret_cast<PFN_vkWaitSemaphores>(next_device_function(*device, "vkWaitSemaphores"));
  next_wait_idle =
      reinterpret_cast<PFN_vkQueueWaitIdle>(next_device_function(*device, "vkQueueWaitIdle"));
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, uint32_t count, const VkSubmitInfo2* infos,
                                      VkFence fence) {
  if (++submission_count >= lostSubmission()) {
    next_wait_idle(queue);  // nothing runs on a lost device, and its objects may be destroyed
    return VK_ERROR_DEVICE_LOST;
  }
  return next_submit(queue, count, infos, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL wait(VkDevice device, const VkSemaphoreWaitInfo* info,
                                    uint64_t timeout_ns) {
  if (submission_count >= lostSubmission()) return VK_ERROR_DEVICE_LOST;
  return next_wait(device, info, timeout_ns);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL deviceFunction(VkDevice device, const char* name) {
  const std::string_view wanted = name;
  if (wanted == "vkGetDeviceProcAddr") return reinterpret_cast<PFN_vkVoidFunction>(deviceFunction);
  if (wanted == "vkQueueSubmit2") return reinterpret_cast<PFN_vkVoidFunction>(submit);
  if (wanted == "vkWaitSemaphores") return reinterpret_cast<PFN_vkVoidFunction>(wait);
  return next_device_function(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instanceFunction(VkInstance instance, const char* name) {
  const std::string_view wanted = name;
  if (wanted == "vkCreateInstance") return reinterpret_cast<PFN_vkVoidFunction>(createInstance);
  if (wanted == "vkCreateDevice") return reinterpret_cast<PFN_vkVoidFunction>(createDevice);
  if (wanted == "vkGetDeviceProcAddr") return reinterpret_cast<PFN_vkVoidFunction>(deviceFunction);
  return next_instance_function(instance, name);
}

}  // namespace

// The one entry point that the loader looks up by name.
extern "C" VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* version) {
  version->loaderLayerInterfaceVersion = 2;
  version->pfnGetInstanceProcAddr = instanceFunction;
  version->pfnGetDeviceProcAddr = deviceFunction;
  version->pfnGetPhysicalDeviceProcAddr = nullptr;
  return VK_SUCCESS;
}
