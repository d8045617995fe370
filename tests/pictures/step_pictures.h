// SPDX-License-Identifier: Apache-2.0
// One picture for each step of the algorithm, as the documents in shaders/ show them.
#pragma once

#include <string>
#include <vector>

#include "gpu/device.h"

namespace viewloom::pictures {

struct Picture {
  std::string file_name;
  std::string svg;
};

// Builds, walks and sweeps the scene to draw. The walk needs the device.
std::vector<Picture> drawSteps(const Device& device);

}  // namespace viewloom::pictures
