// SPDX-License-Identifier: Apache-2.0
// Kinds of picture files, told by their first bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/status.h"

namespace viewloom::files {

enum class Container {
  kUnknown,
  kExr,
  kPng,
  kJpeg,
  kPfm,
  kPnm,
  kNpy,
  kTiff,
  kWebp,
  kBmp,
  kDpt,
  kHeic,
  kYuv,
};

// The name in messages and reports: "PNG".
const char* nameOf(Container container);

// By the file's first bytes, so that a renamed file is read. By its name, in any case, where the
// bytes are no known ones: raw video, damaged files, and files that are not there.
Container containerOf(const std::filesystem::path& path);

// By its name alone.
Container containerOfName(const std::filesystem::path& path);

inline bool isExr(const std::filesystem::path& path) {
  return containerOf(path) == Container::kExr;
}

// The end of the file's name in small letters, with its dot: ".exr"; "" where there is none.
std::string extensionOf(const std::filesystem::path& path);
// The file's name ends so, in any case: ".yuv".
bool hasExtension(const std::filesystem::path& path, std::string_view extension);

// OK for a file that one of the readers takes. Else a sentence that says what the file is (missing,
// a folder, empty, a video, a model, another kind of picture) and what to do.
absl::Status checkPictureFile(const std::filesystem::path& path);

}  // namespace viewloom::files
