// SPDX-License-Identifier: Apache-2.0
// Files that viewloom writes: complete beside their place first, then put there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

#include "base/status.h"

namespace viewloom {

// OK when a file can be written at `path`: nothing stands there, or a regular file, which is
// replaced, and its folder takes new files. Else INVALID_ARGUMENT with the reason: folders,
// devices, pipes, sockets and symbolic links are never replaced.
absl::Status checkOutput(const std::filesystem::path& path);

// Without replace() or placeNew() nothing is left behind. Errors are FAILED_PRECONDITION and name
// the path and the reason, as a full disk. Thread-safety: none.
class OutputFile {
 public:
  // Opens PATH.part. Fails as checkOutput.
  static absl::StatusOr<std::unique_ptr<OutputFile>> create(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  absl::Status write(std::string_view bytes);
  // Cuts what was written down to so many bytes; the next write goes there.
  absl::Status cutTo(uint64_t bytes);
  uint64_t size() const { return size_; }

  // Puts the file at its path, in place of an older regular file. Call once.
  absl::Status replace();
  // Puts the file at its path when nothing stands there; false = something does, and stays. Call
  // once.
  absl::StatusOr<bool> placeNew();

 private:
  OutputFile(std::filesystem::path path, int descriptor);
  absl::Status failed(int error) const;

  const std::filesystem::path path_;
  const std::filesystem::path partial_path_;
  const int descriptor_;
  uint64_t size_ = 0;
  bool is_placed_ = false;
};

}  // namespace viewloom
