// SPDX-License-Identifier: Apache-2.0
#include "gpu/descriptor.h"

#include "gpu/vulkan.h"

namespace viewloom {
namespace {

vk::Format formatOf(TexelFormat format) {
  switch (format) {
    case TexelFormat::kRg32Uint:
      return vk::Format::eR32G32Uint;
    case TexelFormat::kRgba32Uint:
      return vk::Format::eR32G32B32A32Uint;
    case TexelFormat::kR32Float:
      return vk::Format::eR32Sfloat;
    case TexelFormat::kR32Uint:
      break;
  }
  return vk::Format::eR32Uint;
}

}  // namespace

TexelView::TexelView(const Device& device, const Buffer& buffer, TexelFormat format)
    : view_(hide(vk::raii::BufferView(
          device.handle(),
          vk::BufferViewCreateInfo{
              .buffer = buffer.handle(), .format = formatOf(format), .range = VK_WHOLE_SIZE}))) {}

vk::BufferView TexelView::handle() const {
  return **view_;
}

}  // namespace viewloom
