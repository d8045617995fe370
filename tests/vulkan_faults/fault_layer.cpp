// SPDX-License-Identifier: Apache-2.0
// A Vulkan layer that counts the calls of every function, and lets one of them fail.
//
// VIEWLOOM_FAULT_BOARD is the number of an open file that holds a FaultBoard. Without a board,
// VIEWLOOM_FAULT plants one fault: a function, the number of its call from 1, and a VkResult. The
// program has one instance and one device; of several, the newest is served.
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <iterator>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "vulkan_faults/fault_board.h"

namespace {

enum FunctionIndex : uint32_t {
#define HOOK(name, may_lose) kIndexOf_##name,
#include "hooks.inc"
#undef HOOK
  kFunctionCount
};

using Board = viewloom::test::FaultBoard<kFunctionCount>;

constexpr bool kMayLose[] = {
#define HOOK(name, may_lose) may_lose,
#include "hooks.inc"
#undef HOOK
};
constexpr const char* kNames[] = {
#define HOOK(name, may_lose) #name,
#include "hooks.inc"
#undef HOOK
};

std::atomic<PFN_vkVoidFunction> next_functions[kFunctionCount];
PFN_vkGetInstanceProcAddr next_instance_function = nullptr;
PFN_vkGetDeviceProcAddr next_device_function = nullptr;
VkDevice newest_device = VK_NULL_HANDLE;
std::atomic<bool> is_lost = false;
std::mutex queue_mutex;  // users of queues take turns, the wait of a lost device among them

std::optional<uint32_t> indexOf(std::string_view name) {
  const auto found = std::lower_bound(std::begin(kNames), std::end(kNames), name);
  if (found == std::end(kNames) || *found != name) return std::nullopt;
  return uint32_t(found - std::begin(kNames));
}

Board* openBoard() {
  const char* const file = std::getenv("VIEWLOOM_FAULT_BOARD");
  const int flags = file == nullptr ? MAP_PRIVATE | MAP_ANONYMOUS : MAP_SHARED;
  void* const memory = mmap(nullptr, sizeof(Board), PROT_READ | PROT_WRITE, flags,
                            file == nullptr ? -1 : std::atoi(file), 0);
  if (memory == MAP_FAILED) std::abort();
  auto* const board = static_cast<Board*>(memory);
  board->function_count = kFunctionCount;
  const char* const fault = std::getenv("VIEWLOOM_FAULT");
  if (fault == nullptr) return board;
  std::istringstream words(fault);
  std::string name;
  int32_t result = VK_SUCCESS;
  uint32_t number = 0;
  words >> name >> number >> result;
  const std::optional<uint32_t> function = indexOf(name);
  if (!function) std::abort();
  board->function = *function;
  board->result = result;
  board->stays_lost = 1;
  board->left_count = number;
  return board;
}

Board& board() {
  static Board* const kBoard = openBoard();
  return *kBoard;
}

template <typename Pointer>
Pointer nextOf(uint32_t function) {
  return reinterpret_cast<Pointer>(next_functions[function].load());
}

// Nothing runs on a lost device, and its objects may be destroyed.
void loseDevice() {
  std::lock_guard lock(queue_mutex);
  if (is_lost) return;
  const auto wait_idle = reinterpret_cast<PFN_vkDeviceWaitIdle>(
      newest_device == nullptr ? nullptr : next_device_function(newest_device, "vkDeviceWaitIdle"));
  if (wait_idle != nullptr) wait_idle(newest_device);
  is_lost = true;
}

// The planted result, where this is the call that fails.
std::optional<VkResult> takeFault(uint32_t function) {
  Board& shared = board();
  ++shared.call_counts[function];
  if (shared.left_count == 0 || shared.function != function) return std::nullopt;
  uint32_t left = shared.left_count;
  do {
    if (left == 0) return std::nullopt;
  } while (!shared.left_count.compare_exchange_weak(left, left - 1));
  if (left > 1) return std::nullopt;
  const auto result = VkResult(shared.result.load());
  if (result == VK_ERROR_DEVICE_LOST && shared.stays_lost != 0) loseDevice();
  shared.fault_ns = uint64_t(std::chrono::steady_clock::now().time_since_epoch().count());
  ++shared.fault_count;
  return result;
}

// One call of that function: counted, and done unless it fails.
template <typename Call>
auto passed(uint32_t function, const Call& call) -> decltype(call()) {
  using Result = decltype(call());
  const std::optional<VkResult> fault = takeFault(function);
  if constexpr (std::is_same_v<Result, VkResult>) {
    if (fault) return *fault;
    if (is_lost && kMayLose[function]) return VK_ERROR_DEVICE_LOST;
    const VkResult result = call();
    return is_lost && kMayLose[function] ? VK_ERROR_DEVICE_LOST : result;
  } else {
    if (fault) return Result();
    return call();
  }
}

template <uint32_t kFunction, typename Pointer>
struct Hook;

template <uint32_t kFunction, typename Result, typename First, typename... Rest>
struct Hook<kFunction, Result(VKAPI_PTR*)(First, Rest...)> {
  static VKAPI_ATTR Result VKAPI_CALL call(First first, Rest... rest) {
    using Pointer = Result(VKAPI_PTR*)(First, Rest...);
    return passed(kFunction, [&] {
      std::unique_lock lock(queue_mutex, std::defer_lock);
      if constexpr (std::is_same_v<First, VkQueue>) lock.lock();
      return nextOf<Pointer>(kFunction)(first, rest...);
    });
  }
};

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

VkResult makeInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
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

VkResult makeDevice(VkPhysicalDevice physical_device, const VkDeviceCreateInfo* info,
                    const VkAllocationCallbacks* allocator, VkDevice* device) {
  auto* const link =
      findLink<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
  if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  const auto create = reinterpret_cast<PFN_vkCreateDevice>(
      link->u.pLayerInfo->pfnNextGetInstanceProcAddr(VK_NULL_HANDLE, "vkCreateDevice"));
  next_device_function = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const VkResult result = create(physical_device, info, allocator, device);
  if (result != VK_SUCCESS) return result;
  std::lock_guard lock(queue_mutex);
  newest_device = *device;
  is_lost = false;
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info,
                                              const VkAllocationCallbacks* allocator,
                                              VkInstance* instance) {
  return passed(kIndexOf_vkCreateInstance, [&] { return makeInstance(info, allocator, instance); });
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical_device,
                                            const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* allocator,
                                            VkDevice* device) {
  return passed(kIndexOf_vkCreateDevice,
                [&] { return makeDevice(physical_device, info, allocator, device); });
}

VKAPI_ATTR void VKAPI_CALL destroyDevice(VkDevice device, const VkAllocationCallbacks* allocator) {
  {
    std::lock_guard lock(queue_mutex);
    if (newest_device == device) newest_device = VK_NULL_HANDLE;
  }
  passed(kIndexOf_vkDestroyDevice,
         [&] { nextOf<PFN_vkDestroyDevice>(kIndexOf_vkDestroyDevice)(device, allocator); });
}

PFN_vkVoidFunction hookOf(uint32_t function) {
  switch (function) {
    case kIndexOf_vkCreateInstance:
      return reinterpret_cast<PFN_vkVoidFunction>(createInstance);
    case kIndexOf_vkCreateDevice:
      return reinterpret_cast<PFN_vkVoidFunction>(createDevice);
    case kIndexOf_vkDestroyDevice:
      return reinterpret_cast<PFN_vkVoidFunction>(destroyDevice);
    default:
      break;
  }
  static const PFN_vkVoidFunction kHooks[] = {
#define HOOK(name, may_lose) \
  reinterpret_cast<PFN_vkVoidFunction>(Hook<kIndexOf_##name, PFN_##name>::call),
#include "hooks.inc"
#undef HOOK
  };
  return kHooks[function];
}

// The hook of a function that is there below this layer.
PFN_vkVoidFunction hooked(const char* name, PFN_vkVoidFunction next, bool is_newer) {
  const std::optional<uint32_t> function = indexOf(name);
  if (!function || next == nullptr) return next;
  PFN_vkVoidFunction none = nullptr;
  if (is_newer) {
    next_functions[*function] = next;
  } else {
    next_functions[*function].compare_exchange_strong(none, next);
  }
  return hookOf(*function);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL deviceFunction(VkDevice device, const char* name) {
  if (std::string_view(name) == "vkGetDeviceProcAddr") {
    return reinterpret_cast<PFN_vkVoidFunction>(deviceFunction);
  }
  return hooked(name, next_device_function(device, name), true);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instanceFunction(VkInstance instance, const char* name) {
  const std::string_view wanted = name;
  if (wanted == "vkGetInstanceProcAddr") {
    return reinterpret_cast<PFN_vkVoidFunction>(instanceFunction);
  }
  if (wanted == "vkGetDeviceProcAddr") return reinterpret_cast<PFN_vkVoidFunction>(deviceFunction);
  if (wanted == "vkCreateInstance") return hookOf(kIndexOf_vkCreateInstance);
  if (next_instance_function == nullptr) return nullptr;
  return hooked(name, next_instance_function(instance, name), false);
}

}  // namespace

// The one entry point that the loader looks up by name.
extern "C" VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* version) {
  board();  // opened while the program may still open files
  version->loaderLayerInterfaceVersion = 2;
  version->pfnGetInstanceProcAddr = instanceFunction;
  version->pfnGetDeviceProcAddr = deviceFunction;
  version->pfnGetPhysicalDeviceProcAddr = nullptr;
  return VK_SUCCESS;
}
