// SPDX-License-Identifier: Apache-2.0
// Files that viewloom writes. They are completed under another name first, then moved to their
// place.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "base/status.h"

namespace viewloom {

// Checks whether a file can be written at `path`. OK if there is nothing or a regular file, and the
// folder is writable. Otherwise INVALID_ARGUMENT with the reason. Folders, devices, pipes, sockets
// and symbolic links are never replaced.
absl::Status checkOutput(const std::filesystem::path& path);

// A file that is being written. Without replace() or placeNew() it leaves nothing behind. Errors
// are FAILED_PRECONDITION and name the path and the reason, such as a full disk. Thread-safety:
// none.
class OutputFile {
 public:
  // Opens PATH.part, with the permissions of `mode` that the umask leaves. Fails like checkOutput.
  static absl::StatusOr<std::unique_ptr<OutputFile>> create(std::filesystem::path path,
                                                            mode_t mode = 0666);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  absl::Status write(std::string_view bytes);
  // Cuts the file to so many bytes. The next write continues there.
  absl::Status cutTo(uint64_t bytes);
  // Moves everything that is written behind `bytes`, and writes these at the beginning. The file
  // stays as it is if the disk has no room for them.
  absl::Status insertFront(std::string_view bytes);
  uint64_t size() const { return size_; }

  // Gives a file of root to the owner of the one that it replaces; of the folder while there is
  // none. A service that runs as another user can then read it. Does nothing for other users.
  absl::Status keepOwner();
  // Moves the file to its path. It replaces an older regular file. Call once.
  absl::Status replace();
  // Moves the file to its path if nothing is there. Returns false if something is there, which
  // stays. Call once.
  absl::StatusOr<bool> placeNew();

 private:
  OutputFile(std::filesystem::path path, int descriptor);
  absl::Status failed(int error) const;
  absl::Status readAt(uint64_t offset, std::span<char> bytes) const;
  absl::Status writeAt(uint64_t offset, std::string_view bytes) const;

  const std::filesystem::path path_;
  const std::filesystem::path partial_path_;
  const int descriptor_;
  uint64_t size_ = 0;
  bool is_placed_ = false;
};

}  // namespace viewloom
