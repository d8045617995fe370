// SPDX-License-Identifier: Apache-2.0
#include "structure/layered_buffer.h"

#include <algorithm>

namespace viewloom {
namespace {

constexpr uint64_t kPlaceholderBytes = 256;

}  // namespace

LayeredBuffer::LayeredBuffer(const Device& device, const LayeredBufferOptions& options)
    : layer_bytes_(options.layer_bytes), is_divided_(options.is_divided) {
  const uint32_t buffer_count = options.is_divided ? options.layer_count : 1;
  const uint64_t buffer_bytes = layer_bytes_ * (options.is_divided ? 1 : options.layer_count);
  for (uint32_t i = 0; i < buffer_count; ++i) {
    buffers_.emplace_back(device, BufferOptions{.size_bytes = buffer_bytes,
                                                .intent = options.intent,
                                                .debug_name = options.debug_name});
  }
  storage_bytes_ = std::min(buffer_bytes, device.info().limits.storage_bytes_max);
  if (is_divided_) {
    placeholder_ = Buffer(device, {.size_bytes = kPlaceholderBytes, .debug_name = "placeholder"});
  }
  const Buffer& read = is_divided_ ? placeholder_ : buffers_.front();
  texels_ = TexelView(device, read, options.texel_format);
  if (options.has_half_texels) half_texels_ = TexelView(device, read, TexelFormat::kR32Uint);
}

bool LayeredBuffer::mustDivide(const Device& device, const LayeredBufferOptions& options) {
  const DeviceLimits& limits = device.info().limits;
  const uint64_t total_bytes = options.layer_bytes * options.layer_count;
  const uint32_t least_texel_bytes = options.texel_bytes / (options.has_half_texels ? 2 : 1);
  return total_bytes > limits.allocation_bytes_max ||
         total_bytes / least_texel_bytes > limits.texel_count_max;
}

bool LayeredBuffer::fitsStorage(const Device& device, const LayeredBufferOptions& options) {
  return !options.is_divided &&
         options.layer_bytes * options.layer_count <= device.info().limits.storage_bytes_max;
}

uint64_t LayeredBuffer::address(uint32_t layer) const {
  return buffer(layer).address() + offsetBytes(layer);
}

std::span<std::byte> LayeredBuffer::mapped(uint32_t layer) const {
  return buffer(layer).mapped().subspan(offsetBytes(layer), layer_bytes_);
}

Descriptor LayeredBuffer::asTexels(uint32_t binding) const {
  return {.binding = binding, .kind = DescriptorKind::kTexels, .texels = &texels_};
}

Descriptor LayeredBuffer::asHalfTexels(uint32_t binding) const {
  return {.binding = binding, .kind = DescriptorKind::kTexels, .texels = &half_texels_};
}

Descriptor LayeredBuffer::asStorage(uint32_t binding) const {
  return {.binding = binding,
          .kind = DescriptorKind::kStorage,
          .buffer = &buffers_.front(),
          .size_bytes = storage_bytes_};
}

bool LayeredBuffer::fitsStorage(const Device& device) const {
  return !isDivided() && buffers_.front().sizeBytes() <= device.info().limits.storage_bytes_max;
}

}  // namespace viewloom
