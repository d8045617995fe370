// SPDX-License-Identifier: Apache-2.0
// Finds colour and depth among the channels of OpenEXR files, by the names that tools give them and
// by the names that users give.
#pragma once

#include <string>
#include <vector>

#include "base/status.h"
#include "files/exr_description.h"

namespace viewloom::files {

// Names to ask for, as readExrColor and readExrDepth take them; empty where there are none.
struct ExrViewChannels {
  std::vector<std::string> color;  // R, G, B and perhaps A; Y, RY, BY and perhaps A; or Y
  std::vector<std::string> depth;  // one
};

// Colour of the layer that is the picture by its name ("", rgba, Combined, beauty, Image, ...), or
// of the only layer; depth of a channel that is one by its name (Z, depth.Z, Depth.V, WorldDepth.R,
// zdepth, Pz, ...). X, Y, Z side by side are positions or normals, and no depth. Case does not
// matter. `view`: "" = the file's default view.
ExrViewChannels usualExrChannels(const ExrDescription& description, const std::string& view);

// Depth of a file that holds nothing else: the usual channel, else the only one of any name, else
// the R, G and B of the only layer, which have to agree. Empty where it is not clear.
std::vector<std::string> onlyExrDepth(const ExrDescription& description, const std::string& view);

// Channels that a user names: a layer ("beauty"), or channels ("r,g,b"). Case does not matter.
// Errors name the option and what there is.
absl::StatusOr<std::vector<std::string>> namedExrColor(const ExrDescription& description,
                                                       const std::string& view,
                                                       const std::string& wanted);
absl::StatusOr<std::vector<std::string>> namedExrDepth(const ExrDescription& description,
                                                       const std::string& view,
                                                       const std::string& wanted);

// The view that `view` stands for; INVALID_ARGUMENT with the views that there are when it is none.
absl::StatusOr<std::string> exrView(const ExrDescription& description, const std::string& view);

// Whether X, Y and Z lie side by side without colour: a point for every px.
bool hasPositionsAlone(const ExrDescription& description);

}  // namespace viewloom::files
