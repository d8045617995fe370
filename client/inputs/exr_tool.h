// SPDX-License-Identifier: Apache-2.0
// Which tool wrote an EXR file, by its header.
#pragma once

#include <optional>

#include "files/exr_description.h"
#include "inputs/input_settings.h"

namespace viewloom::inputs {

// A renderer that names itself in attributes ("arnold/version", Software, renderer) or in names of
// channels ("VRayZDepth"), or Blender. Nothing of Nuke, which passes on depth of any kind.
std::optional<InputKind> toolOf(const files::ExrDescription& description);

// Whether Nuke wrote the file.
bool isOfNuke(const files::ExrDescription& description);

}  // namespace viewloom::inputs
