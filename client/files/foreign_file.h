// SPDX-License-Identifier: Apache-2.0
// Files that users take for pictures with depth: videos, models, archives, other pictures.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace viewloom::files {

inline constexpr char kPictureKinds[] =
    "EXR, PNG, JPEG, TIFF, WebP, HEIC, PFM, PGM, PPM, BMP, NPY and DPT";

struct ForeignKind {
  std::string what;    // "a video (MP4)"
  std::string remedy;  // what to do, as the rest of a sentence
};

// By the file's first bytes, or by its name for formats that begin as they like. Nothing for files
// of no known kind.
std::optional<ForeignKind> foreignKind(std::string_view head, const std::filesystem::path& path);

}  // namespace viewloom::files
