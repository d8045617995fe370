// SPDX-License-Identifier: Apache-2.0
// Data that a shader reads and writes through bindings: pushed with each dispatch, never pooled.
//
// Most data could be reached by address alone, but software devices load through bindings several
// times faster (shaders/README.md, Memory).
#pragma once

#include <cstdint>

#include "gpu/buffer.h"

namespace viewloom {

enum class DescriptorKind : uint8_t {
  kTexels,   // usamplerBuffer, samplerBuffer: a TexelView
  kStorage,  // buffer block: up to DeviceLimits::storage_bytes_max
  kUniform   // uniform block: the same for all invocations
};

// A binding of a shader, in set 0.
struct DescriptorSlot {
  uint32_t binding = 0;
  DescriptorKind kind = DescriptorKind::kStorage;
};

// Contents of a slot for one dispatch.
struct Descriptor {
  uint32_t binding = 0;
  DescriptorKind kind = DescriptorKind::kStorage;
  const Buffer* buffer = nullptr;  // kStorage, kUniform
  uint64_t offset_bytes = 0;       // a multiple of 256 serves every device
  uint64_t size_bytes = 0;
  const TexelView* texels = nullptr;  // kTexels
};

}  // namespace viewloom
