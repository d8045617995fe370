// SPDX-License-Identifier: Apache-2.0
// OpenEXR: colour and depth planes of flat files with one or more parts and views.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "files/plane_image.h"

namespace viewloom::files {

// A plane is as large as the display window. What the data window has beyond it is cut off; what it
// lacks is 0: black and transparent, or depth 0. Deep parts, subsampled channels and headers that
// ask for more than the limits are refused before pixels are read.
//
// A channel is named as in the file ("R", "left.Z"), or as <part name or view>.<channel>; the
// default view of a multi-view file may be named though its channels have no prefix.

// Binary16 RGBA, linear light. channels: 3 or 4 names in the order R, G, B, A, or one for grey;
// none stands for R, G, B and A as far as there are, else Y. Infinite samples become the largest
// finite ones, NaN becomes 0.
absl::StatusOr<PlaneImage> readExrColor(const std::filesystem::path& path,
                                        std::span<const std::string> channels);

// Binary16 or binary32 as stored. channels: one name; none stands for Z.
absl::StatusOr<PlaneImage> readExrDepth(const std::filesystem::path& path,
                                        std::span<const std::string> channels);

// The names to ask for to get one view of a file; empty lists where it has none.
struct ExrViewChannels {
  std::vector<std::string> color;
  std::vector<std::string> depth;
};

// view: "left", "right" or any other the file has; "" = the file's default view.
absl::StatusOr<ExrViewChannels> exrChannelsOfView(const std::filesystem::path& path,
                                                  const std::string& view);

}  // namespace viewloom::files
