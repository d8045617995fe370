// SPDX-License-Identifier: Apache-2.0
// One compute shader, ready to be dispatched: what it needs comes by push constants and
// descriptors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/descriptor.h"

namespace viewloom {

// A value that a kernel is specialised to (shaders/shared/kernel_constants.h); of a bool, 0 or 1.
struct KernelConstant {
  uint32_t id = 0;
  uint32_t value = 0;
};

// Groups [first, end) of a row of groups.
struct GroupColumns {
  uint32_t first = 0;
  uint32_t end = 0;
};

// Rows [first, end) of groups.
struct GroupRows {
  uint32_t first = 0;
  uint32_t end = 0;
};

struct ComputePassOptions {
  std::span<const uint32_t> spirv;
  uint32_t push_bytes = 0;   // at most DeviceLimits::push_bytes_max, a multiple of 4
  bool takes_parts = false;  // whether recordColumns() and recordRows() may be called
  // All that the kernel has; the two of lib/memory.glsl may be left out, and then are false.
  std::span<const KernelConstant> constants = {};
  std::span<const DescriptorSlot> descriptors = {};
  const char* debug_name = "";
};

// The constant_id under which shaders learn of Device::plantedFault().
inline constexpr uint32_t kFaultConstantId = 31;

// The device must outlive it. Thread-safety: const methods may be called from any thread.
class ComputePass {
 public:
  ComputePass(const Device& device, const ComputePassOptions& options);

  // Dispatches with these push constants; `push` has exactly push_bytes. Does not synchronise.
  void record(Commands commands, std::span<const std::byte> push, uint32_t groups_x,
              uint32_t groups_y = 1, uint32_t groups_z = 1) const;

  // The same of these columns of the groups alone: their place is told as if all were dispatched,
  // but gl_NumWorkGroups counts them.
  void recordColumns(Commands commands, std::span<const std::byte> push, GroupColumns columns,
                     uint32_t groups_y) const;
  // The same of these rows of the groups alone.
  void recordRows(Commands commands, std::span<const std::byte> push, uint32_t groups_x,
                  GroupRows rows) const;

  // The same, with as many groups as three words of a buffer say when the device gets there.
  void recordIndirect(Commands commands, std::span<const std::byte> push, const Buffer& groups,
                      uint64_t offset_bytes) const;

  // The descriptors of the next dispatch; slots that the shader does not use may be left out.
  void recordDescriptors(Commands commands, std::span<const Descriptor> descriptors) const;

  template <typename Push>
  requires std::is_trivially_copyable_v<Push> && std::is_class_v<Push> &&
      (!std::is_convertible_v<Push, std::span<const std::byte>>)void record(
          Commands commands, const Push& push, uint32_t groups_x, uint32_t groups_y = 1,
          uint32_t groups_z = 1) const {
    record(commands, std::as_bytes(std::span(&push, 1)), groups_x, groups_y, groups_z);
  }

  template <typename Push>
  requires std::is_trivially_copyable_v<Push> && std::is_class_v<Push> &&
      (!std::is_convertible_v<Push, std::span<const std::byte>>)void recordIndirect(
          Commands commands, const Push& push, const Buffer& groups, uint64_t offset_bytes) const {
    recordIndirect(commands, std::as_bytes(std::span(&push, 1)), groups, offset_bytes);
  }

  template <typename Push>
  requires std::is_trivially_copyable_v<Push> && std::is_class_v<Push> &&
      (!std::is_convertible_v<Push, std::span<const std::byte>>)void recordColumns(
          Commands commands, const Push& push, GroupColumns columns, uint32_t groups_y) const {
    recordColumns(commands, std::as_bytes(std::span(&push, 1)), columns, groups_y);
  }

  template <typename Push>
  requires std::is_trivially_copyable_v<Push> && std::is_class_v<Push> &&
      (!std::is_convertible_v<Push, std::span<const std::byte>>)void recordRows(
          Commands commands, const Push& push, uint32_t groups_x, GroupRows rows) const {
    recordRows(commands, std::as_bytes(std::span(&push, 1)), groups_x, rows);
  }

 private:
  void recordState(Commands commands, std::span<const std::byte> push) const;

  const Device* device_;
  uint32_t push_bytes_;
  bool takes_parts_;
  Hidden<vk::raii::DescriptorSetLayout> slots_;
  Hidden<vk::raii::PipelineLayout> layout_;
  Hidden<vk::raii::Pipeline> pipeline_;
};

}  // namespace viewloom
