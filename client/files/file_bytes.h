// SPDX-License-Identifier: Apache-2.0
// Whole files as bytes, up to a limit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace viewloom::files {

// The largest file that is read: an 8192 x 8192 plane of four floats and room for a header.
inline constexpr uint64_t kFileBytesMax = (uint64_t{8192} * 8192 + 4096) * 16;

// INVALID_ARGUMENT that says which file, what came and what is accepted.
absl::Status refuseFile(const std::string& path, const std::string& problem);

// INVALID_ARGUMENT for a file that ends before its picture is whole, or is otherwise broken.
// `format` and `detail` say where: "PNG", "IDAT: CRC error".
absl::Status refuseCutShort(const std::string& path, const std::string& format);
absl::Status refuseDamaged(const std::string& path, const std::string& format,
                           const std::string& detail);

// NOT_FOUND with the path, or INVALID_ARGUMENT when it is larger than bytes_max.
absl::StatusOr<std::vector<uint8_t>> readFileBytes(const std::filesystem::path& path,
                                                   uint64_t bytes_max = kFileBytesMax);

// OK when the path is a file that can be read, is not empty and no larger than kFileBytesMax.
absl::Status checkFile(const std::filesystem::path& path);

// Writes beside the path and renames: readers see the old file, or the whole new one. Fails as
// OutputFile: only regular files are replaced.
absl::Status writeFileWhole(const std::filesystem::path& path, std::string_view bytes);

// The same where there is no such file yet; false = there is, and it stays.
absl::StatusOr<bool> writeNewFile(const std::filesystem::path& path, std::string_view bytes);

}  // namespace viewloom::files
