// SPDX-License-Identifier: Apache-2.0
// PFM: portable float maps, bottom row first, of either byte order.
#pragma once

#include <filesystem>

#include "files/plane_image.h"

namespace viewloom::files {

// "PF" as colour: binary16 RGBA with alpha 1. The scale's size is ignored, its sign is the byte
// order.
absl::StatusOr<PlaneImage> readPfmColor(const std::filesystem::path& path);
// "Pf" as depth: binary32.
absl::StatusOr<PlaneImage> readPfmDepth(const std::filesystem::path& path);

}  // namespace viewloom::files
