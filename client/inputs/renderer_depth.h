// SPDX-License-Identifier: Apache-2.0
// Depth as renderers write it: with any sign, and with huge numbers where they hit nothing.
#pragma once

#include <string>
#include <vector>

#include "base/byte_pool.h"
#include "inputs/input_settings.h"

namespace viewloom::inputs {

// Arnold, V-Ray, Redshift and Houdini.
bool isRenderer(InputKind kind);

// Metric depth of floats, as far as the settings do not say it: depth that is negative is turned
// over, and what is 1e9 and more, as 1e30, becomes infinitely far. `notes`: what was found.
void settleRendererDepth(const InputSettings& settings, v1::Plane& plane, SharedBytes& bytes,
                         std::vector<std::string>& notes);

}  // namespace viewloom::inputs
