// SPDX-License-Identifier: Apache-2.0
// How much light rough surfaces mirror in all, for the kernels of reflections.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>

#include "gpu/buffer.h"
#include "gpu/descriptor.h"
#include "shared/ggx.h"

namespace viewloom {

using AlbedoTable = std::array<uint32_t, size_t{abi::kAlbedoSteps} * abi::kAlbedoSteps>;

// The table that abi::kAlbedoSteps describes, made once. Thread-safety: may be called from any
// thread.
const AlbedoTable& albedoTable();

// The table on a device, which must outlive it. Thread-safety: may be called from any thread.
class Albedos {
 public:
  explicit Albedos(const Device& device) : device_(&device) {}

  // At abi::kBindingAlbedos; brought there when it is first asked for.
  Descriptor descriptor();

 private:
  const Device* device_;
  std::once_flag is_there_;
  Buffer buffer_;
};

}  // namespace viewloom
