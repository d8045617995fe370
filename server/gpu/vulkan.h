// SPDX-License-Identifier: Apache-2.0
// The one way Vulkan is included: handles that clean up after themselves, designated initialisers.
#pragma once

#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#include <vulkan/vulkan_raii.hpp>
