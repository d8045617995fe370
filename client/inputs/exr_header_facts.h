// SPDX-License-Identifier: Apache-2.0
// Facts of an EXR header that count for every kind of file: px that are not square, the camera, the
// primaries, environment maps.
#pragma once

#include <string>

#include "base/status.h"
#include "files/exr_description.h"
#include "inputs/interpretation.h"

namespace viewloom::inputs {

// Sets the aspect of px and the projection of `result`, and notes them and the primaries.
void readHeaderFacts(const InputSettings& settings, const files::ExrDescription& description,
                     Interpretation& result);

// Sets the camera that worldToCamera or Unreal's attributes state; `file` is for messages.
absl::Status readHeaderCamera(const InputSettings& settings, const std::string& file,
                              const files::ExrDescription& description, Interpretation& result);

}  // namespace viewloom::inputs
