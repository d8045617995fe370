// SPDX-License-Identifier: Apache-2.0
// Pictures of any container but OpenEXR, HEIC and raw video.
#pragma once

#include <filesystem>

#include "files/container.h"
#include "files/picture.h"

namespace viewloom::files {

// Upright, rows from the top. INVALID_ARGUMENT in the user's words for what is no such picture.
absl::StatusOr<Picture> readPicture(const std::filesystem::path& path, PictureUse use);

}  // namespace viewloom::files
