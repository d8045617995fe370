// SPDX-License-Identifier: Apache-2.0
#include "gpu/descriptor.h"

namespace viewloom {

TexelView::TexelView(const Device& device, const Buffer& buffer, vk::Format format)
    : view_(device.handle(),
            vk::BufferViewCreateInfo{
                .buffer = buffer.handle(), .format = format, .range = VK_WHOLE_SIZE}) {}

}  // namespace viewloom
