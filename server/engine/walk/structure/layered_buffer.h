// SPDX-License-Identifier: Apache-2.0
// An array per layer: in one buffer, read as texels, where the device allows that; else one buffer
// each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/descriptor.h"

namespace viewloom {

struct LayeredBufferOptions {
  uint64_t layer_bytes = 0;
  uint32_t layer_count = 1;
  TexelFormat texel_format = TexelFormat::kR32Uint;
  uint32_t texel_bytes = 4;
  bool has_half_texels = false;  // also read as texels of one uint; texels have two
  // Whether all layers must be divided because another array of the same structure is.
  bool is_divided = false;
  MemoryIntent intent = MemoryIntent::kDeviceOnly;
  const char* debug_name = "";
};

// The device must outlive it. Thread-safety: const methods may be called from any thread.
class LayeredBuffer {
 public:
  LayeredBuffer(const Device& device, const LayeredBufferOptions& options);

  // Whether these arrays are too large for one buffer, or for one texel view.
  static bool mustDivide(const Device& device, const LayeredBufferOptions& options);
  // Whether one storage descriptor reaches all of such arrays.
  static bool fitsStorage(const Device& device, const LayeredBufferOptions& options);

  uint64_t address(uint32_t layer) const;
  // Where a layer lies, for copies.
  const Buffer& buffer(uint32_t layer) const { return buffers_[is_divided_ ? layer : 0]; }
  uint64_t offsetBytes(uint32_t layer) const { return is_divided_ ? 0 : layer * layer_bytes_; }
  uint64_t layerBytes() const { return layer_bytes_; }
  // A layer's bytes, unless the intent is kDeviceOnly.
  std::span<std::byte> mapped(uint32_t layer) const;

  // Descriptors of all layers. What stands there for arrays that are reached by address is valid,
  // as Vulkan asks of every binding, and never used.
  Descriptor asTexels(uint32_t binding) const;
  Descriptor asHalfTexels(uint32_t binding) const;  // with options.has_half_texels
  Descriptor asStorage(uint32_t binding) const;
  bool isDivided() const { return is_divided_; }
  bool fitsStorage(const Device& device) const;

 private:
  uint64_t layer_bytes_;
  bool is_divided_;
  uint64_t storage_bytes_;  // of the storage descriptor
  std::vector<Buffer> buffers_;
  Buffer placeholder_;  // of divided arrays
  TexelView texels_;
  TexelView half_texels_;
};

}  // namespace viewloom
