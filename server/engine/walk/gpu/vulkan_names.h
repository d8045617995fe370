// SPDX-License-Identifier: Apache-2.0
// Names of Vulkan for headers, which only pass them on: gpu/vulkan.h takes seconds to compile, and
// only the sources of this folder include it.
#pragma once

#include <memory>

struct VkCommandBuffer_T;

namespace vk {
class Buffer;
class BufferView;
class Semaphore;
struct DebugUtilsMessengerCreateInfoEXT;
struct SubmitInfo2;
enum class ObjectType;
namespace raii {
class Buffer;
class BufferView;
class CommandBuffer;
class CommandPool;
class DescriptorSetLayout;
class Device;
class DeviceMemory;
class PhysicalDevice;
class Pipeline;
class PipelineCache;
class PipelineLayout;
class QueryPool;
class Semaphore;
}  // namespace raii
}  // namespace vk

namespace viewloom {

// Owns a handle of Vulkan, or none; hide() in gpu/vulkan.h makes it.
template <typename Handle>
class Hidden {
 public:
  Hidden() = default;
  Hidden(Handle* handle, void (*destroy)(Handle*)) : handle_(handle, destroy) {}

  explicit operator bool() const { return handle_ != nullptr; }
  const Handle& operator*() const { return *handle_; }
  Handle& operator*() { return *handle_; }
  const Handle* operator->() const { return handle_.get(); }
  Handle* operator->() { return handle_.get(); }

 private:
  std::unique_ptr<Handle, void (*)(Handle*)> handle_{nullptr, nullptr};
};

}  // namespace viewloom
