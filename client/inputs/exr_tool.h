// SPDX-License-Identifier: Apache-2.0
// Which tool wrote an EXR file, by its header, and which channels that tool gives colour and depth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "files/exr_description.h"
#include "inputs/input_settings.h"

namespace viewloom::inputs {

// A renderer that names itself in attributes ("arnold/version", Software, renderer) or in names of
// channels ("VRayZDepth"), or Blender. Nothing of Nuke: see nuke_depth.h.
std::optional<InputKind> toolOf(const files::ExrDescription& description);

// Whether Nuke wrote the file.
bool isOfNuke(const files::ExrDescription& description);

// Whether a channel is Z of Nuke's layer depth: depth.Z, with a view before or within.
bool isDepthOfNuke(const std::string& channel);

struct ExrLayers {
  std::vector<std::string> color;  // R, G, B and perhaps A
  std::string depth;
};

// <layer>.Combined.R and so on, <layer>.Depth.Z; a view's name comes before the last part. The
// first layer that has both. Nothing where there is none.
std::optional<ExrLayers> blenderLayers(const files::ExrDescription& description,
                                       const std::string& view);

// Depth is <any>WorldDepth.R; colour is FinalImage<any>.R and so on, but of none of the passes
// beside the picture (which have MovieRenderQueue_ in their names), or R and so on without a
// prefix. Nothing where there is none.
std::optional<ExrLayers> unrealLayers(const files::ExrDescription& description);

}  // namespace viewloom::inputs
