// SPDX-License-Identifier: Apache-2.0
#include "files/file_bytes.h"

#include <fstream>
#include <system_error>

#include "absl/strings/str_cat.h"
#include "base/output_file.h"

namespace viewloom::files {
namespace {

absl::StatusOr<uint64_t> fileSize(const std::filesystem::path& path, uint64_t bytes_max) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return absl::NotFoundError(absl::StrCat(path.string(), ": no such file"));
  }
  const uint64_t size = std::filesystem::file_size(path, error);
  if (error) return absl::NotFoundError(absl::StrCat(path.string(), ": ", error.message()));
  if (size > bytes_max) {
    return refuseFile(path.string(),
                      absl::StrCat("has ", size, " bytes; accepted are up to ", bytes_max));
  }
  return size;
}

}  // namespace

absl::Status refuseFile(const std::string& path, const std::string& problem) {
  return absl::InvalidArgumentError(absl::StrCat(path, ": ", problem));
}

absl::Status checkFile(const std::filesystem::path& path) {
  return fileSize(path, kFileBytesMax).status();
}

absl::StatusOr<std::vector<uint8_t>> readFileBytes(const std::filesystem::path& path,
                                                   uint64_t bytes_max) {
  const absl::StatusOr<uint64_t> size = fileSize(path, bytes_max);
  if (!size.ok()) return size.status();
  std::vector<uint8_t> bytes(*size);
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) return absl::DataLossError(absl::StrCat(path.string(), ": cannot be read"));
  return bytes;
}

absl::Status writeFileWhole(const std::filesystem::path& path, std::string_view bytes) {
  auto out = OutputFile::create(path);
  if (!out.ok()) return out.status();
  VIEWLOOM_RETURN_IF_ERROR((*out)->write(bytes));
  return (*out)->replace();
}

absl::StatusOr<bool> writeNewFile(const std::filesystem::path& path, std::string_view bytes) {
  std::error_code error;
  if (std::filesystem::exists(std::filesystem::symlink_status(path, error))) return false;
  auto out = OutputFile::create(path);
  if (!out.ok()) return out.status();
  VIEWLOOM_RETURN_IF_ERROR((*out)->write(bytes));
  return (*out)->placeNew();
}

}  // namespace viewloom::files
