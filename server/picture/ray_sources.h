// SPDX-License-Identifier: Apache-2.0
// Parameters of kernels for displays whose rays do not all start at their view's eye.
#pragma once

#include "display/atlas_layout.h"
#include "shared/trace_abi.h"

namespace viewloom {

// abi::kRaysOf...: which kernel makes the rays of a display.
uint32_t raySourceOf(const AtlasLayout& layout);

// Nothing, for displays without. `sample`: of each px.
abi::Microlenses microlensesOf(const AtlasLayout& layout);
abi::LenticularEyes lenticularEyesOf(const AtlasLayout& layout, uint32_t sample);

}  // namespace viewloom
