// SPDX-License-Identifier: Apache-2.0
#include "files/file_bytes.h"

#include <fstream>
#include <system_error>

#include "base/output_file.h"
#include "base/str_cat.h"

namespace viewloom::files {
namespace {

absl::StatusOr<uint64_t> fileSize(const std::filesystem::path& path, uint64_t bytes_max) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    return refuseFile(path.string(),
                      "is a folder; name its files, as FOLDER/*.exr, or follow it with publish "
                      "--watch-folder");
  }
  if (!std::filesystem::is_regular_file(path, error)) {
    return absl::NotFoundError(
        strCat(path.string(), ": no such file; check the name and the folder"));
  }
  const uint64_t size = std::filesystem::file_size(path, error);
  if (error) return absl::NotFoundError(strCat(path.string(), ": ", error.message()));
  if (size > bytes_max) {
    return refuseFile(path.string(),
                      strCat("has ", size, " bytes; accepted are up to ", bytes_max));
  }
  return size;
}

}  // namespace

absl::Status refuseFile(const std::string& path, const std::string& problem) {
  return absl::InvalidArgumentError(strCat(path, ": ", problem));
}

absl::Status refuseCutShort(const std::string& path, const std::string& format) {
  return refuseFile(path, strCat("ends before its picture is whole (", format,
                                 "): it is cut short or still being written; wait until it "
                                 "is complete, or write it again"));
}

absl::Status refuseDamaged(const std::string& path, const std::string& format,
                           const std::string& detail) {
  return refuseFile(path,
                    strCat("is damaged (", format, ": ", detail, "); copy or export it again"));
}

absl::Status checkFile(const std::filesystem::path& path) {
  const absl::StatusOr<uint64_t> size = fileSize(path, kFileBytesMax);
  if (!size.ok()) return size.status();
  if (*size > 0) return absl::OkStatus();
  return refuseFile(path.string(), "is empty: its writer failed or has not begun; write it again");
}

absl::StatusOr<std::vector<uint8_t>> readFileBytes(const std::filesystem::path& path,
                                                   uint64_t bytes_max) {
  const absl::StatusOr<uint64_t> size = fileSize(path, bytes_max);
  if (!size.ok()) return size.status();
  std::vector<uint8_t> bytes(*size);
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) return absl::DataLossError(strCat(path.string(), ": cannot be read"));
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
