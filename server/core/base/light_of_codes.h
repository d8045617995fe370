// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace viewloom {

// Linear light, 0..1, by codes of sRGB (IEC 61966-2-1).
const std::array<float, 256>& lightOfCodes();

}  // namespace viewloom
