// SPDX-License-Identifier: Apache-2.0
// The Vulkan device: chosen, checked, and the one queue all GPU work goes through.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gpu/device_error.h"
#include "gpu/vulkan_names.h"

namespace viewloom {

struct DeviceOptions {
  // An index as listDevices() gives it, or part of a name; "" = the first real GPU, else lavapipe.
  std::string select;
  // A folder in which compiled kernels stay from one start to the next; "" = they do not. Software
  // devices have nothing to keep.
  std::string kernel_folder{};
  bool validation = false;  // core and synchronization validation; needs the Khronos layer
  // For tests of the tests: the mistake that every shader makes which knows it. 0 = none.
  uint32_t planted_fault = 0;
  // For tests: act like a device whose bindings are no larger, so that small arrays do not fit.
  uint64_t storage_bytes_max = UINT64_MAX;
  uint64_t texel_count_max = UINT64_MAX;
  // For tests: act like a device with memory of its own, into which planes are copied.
  bool has_own_memory = false;
};

struct DeviceLimits {
  uint64_t allocation_bytes_max = 0;  // of one buffer
  uint64_t memory_bytes = 0;          // device-local heaps together
  uint64_t storage_bytes_max = 0;     // of one storage descriptor
  uint64_t texel_count_max = 0;       // of one TexelView
  uint32_t push_bytes_max = 0;
  uint32_t groups_max[3] = {};  // of one dispatch, per axis
  uint32_t group_size_max = 0;  // invocations
};

struct DeviceInfo {
  uint32_t index = 0;  // what DeviceOptions::select takes
  std::string name;
  std::string driver;  // name, version
  bool is_software = false;
  bool shares_memory = false;  // its memory is the CPU's: nothing need be copied to it or back
  DeviceLimits limits;
  std::vector<std::string> missing_features;  // empty = viewloom runs on it
};

// Owns instance, device and queue. Throws std::runtime_error with the remedy when there is no
// usable device. Thread-safety: all methods may be called from any thread.
class Device {
 public:
  explicit Device(const DeviceOptions& options);
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  ~Device();

  // Every device Vulkan offers; none, and no exception, when there is no Vulkan at all.
  static std::vector<DeviceInfo> listDevices();

  const vk::raii::Device& handle() const;
  const vk::raii::PhysicalDevice& physicalDevice() const;
  uint32_t queueFamily() const { return queue_family_; }
  const DeviceInfo& info() const { return info_; }
  uint32_t plantedFault() const { return planted_fault_; }

  // Nanoseconds per timestamp tick; 0 = the queue has no timestamps.
  double timestampPeriodNs() const { return timestamp_period_ns_; }
  uint32_t timestampValidBits() const { return timestamp_valid_bits_; }

  void submit(const vk::SubmitInfo2& submission) const;

  const vk::raii::PipelineCache& pipelineCache() const;
  // Kernels that were compiled so far, whether or not the cache had them.
  uint64_t kernelCount() const { return kernel_count_; }
  void noteKernel() const { ++kernel_count_; }
  // Writes the kernels that are compiled so far to the folder.
  void keepKernels() const;

  // A name for the validation layers; nothing happens without them.
  void setName(vk::ObjectType type, uint64_t handle, const char* name) const;
  const ValidationLog& validationLog() const { return validation_log_; }

 private:
  struct Handles;

  ValidationLog validation_log_;  // outlives the messenger
  bool validation_;
  uint32_t planted_fault_;
  DeviceInfo info_;
  uint32_t queue_family_;
  double timestamp_period_ns_ = 0;
  uint32_t timestamp_valid_bits_ = 0;
  std::unique_ptr<Handles> handles_;
  mutable std::mutex queue_mutex_;   // guards the queue
  mutable std::mutex kernel_mutex_;  // guards the file of kernels
  mutable std::atomic<uint64_t> kernel_count_ = 0;
};

}  // namespace viewloom
