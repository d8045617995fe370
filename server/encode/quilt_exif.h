// SPDX-License-Identifier: Apache-2.0
// Metadata in the JPEG of a quilt, for players that read it instead of the file's name.
#pragma once

#include <cstdint>
#include <vector>

#include "display/atlas_layout.h"

namespace viewloom {

// An APP1 segment, marker and length included, that belongs right behind SOI: Exif with one
// UserComment, the text of quiltJson(). Empty for layouts that are no quilt.
std::vector<uint8_t> quiltExif(const AtlasLayout& layout);

}  // namespace viewloom
