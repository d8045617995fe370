// SPDX-License-Identifier: Apache-2.0
// The one way Vulkan is included: handles that clean up after themselves, designated initialisers.
#pragma once

#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#include <utility>

#include <vulkan/vulkan_raii.hpp>

#include "gpu/vulkan_names.h"

namespace viewloom {

template <typename Handle>
Hidden<Handle> hide(Handle handle) {
  return {new Handle(std::move(handle)), [](Handle* owned) { delete owned; }};
}

}  // namespace viewloom
