// SPDX-License-Identifier: Apache-2.0
// What a file's name says of its format, in any case.
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>

namespace viewloom::files {

// In small letters, with its dot: ".exr"; "" where there is none.
inline std::string extensionOf(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  return extension;
}

inline bool hasExtension(const std::filesystem::path& file, std::string_view extension) {
  return extensionOf(file) == extension;
}

}  // namespace viewloom::files
