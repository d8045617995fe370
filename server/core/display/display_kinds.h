// SPDX-License-Identifier: Apache-2.0
// List of all kinds of displays. Add a new kind here.
#pragma once

#include <utility>
#include <variant>

#include "display/cameras.h"
#include "display/integral.h"
#include "display/lenticular.h"
#include "display/quilt.h"
#include "display/rgbd.h"
#include "display/stereo.h"

namespace viewloom {

using DisplayKind =
    std::variant<QuiltSpec, StereoSpec, CamerasSpec, LenticularSpec, IntegralSpec, RgbdSpec>;

// Calls `function` with an empty spec of each kind.
template <typename Function>
void forEachKind(const Function& function) {
  [&]<size_t... kIndex>(std::index_sequence<kIndex...>) {
    (function(std::variant_alternative_t<kIndex, DisplayKind>()), ...);
  }
  (std::make_index_sequence<std::variant_size_v<DisplayKind>>());
}

}  // namespace viewloom
