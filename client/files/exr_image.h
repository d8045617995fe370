// SPDX-License-Identifier: Apache-2.0
// OpenEXR: colour and depth planes of flat files with one or more parts and views.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "files/exr_header.h"
#include "files/exr_usual.h"
#include "files/plane_image.h"

namespace viewloom::files {

// A plane is as large as the window. Deep parts, depth and R, G, B that are subsampled, and headers
// that ask for more than the limits are refused before pixels are read.
//
// A channel is named as in the file ("R", "left.Z"), or as <part name or view>.<channel>; the
// default view of a multi-view file may be named though its channels have no prefix.

// Binary16 RGBA, linear light. channels: 3 or 4 names in the order R, G, B, A; or Y, RY, BY and A,
// luminance and chroma, which become R, G, B by the file's chromaticities; or one for grey. None
// stands for the usual ones (exr_usual.h). Infinite samples become the largest finite ones, NaN
// becomes 0. Where the file has no data: black and transparent. `window`: none = display window.
absl::StatusOr<PlaneImage> readExrColor(const std::filesystem::path& path,
                                        std::span<const std::string> channels,
                                        const std::optional<ExrWindow>& window = {});

// Binary16 or binary32 as stored; whole numbers as binary32. channels: one name, or several that
// have to agree; none stands for the usual one. `fill`: the sample where the file has no data.
absl::StatusOr<PlaneImage> readExrDepth(const std::filesystem::path& path,
                                        std::span<const std::string> channels,
                                        const std::optional<ExrWindow>& window = {},
                                        float fill = 0);

// The names to ask for to get one view of a file; empty lists where it has none. view: "left",
// "right" or any other the file has; "" = the file's default view.
absl::StatusOr<ExrViewChannels> exrChannelsOfView(const std::filesystem::path& path,
                                                  const std::string& view);

}  // namespace viewloom::files
