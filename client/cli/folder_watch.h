// SPDX-License-Identifier: Apache-2.0
// Names of files in a folder as they become complete.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/status.h"

namespace viewloom::cli {

// A file is complete once its writer closes it, or moves it into the folder (inotify). What another
// machine writes to a shared folder is not seen.
// Thread-safety: none; one owner.
class FolderWatch {
 public:
  // INVALID_ARGUMENT when it is no folder that can be watched.
  static absl::StatusOr<std::unique_ptr<FolderWatch>> open(const std::filesystem::path& folder);
  ~FolderWatch();
  FolderWatch(const FolderWatch&) = delete;
  FolderWatch& operator=(const FolderWatch&) = delete;

  // Those that became complete since the last call, in that order, without the folder's name; a
  // file written again comes again. The first call gives what was there already, by name, but for
  // files that are being written. Never blocks. NOT_FOUND once the folder is gone.
  absl::StatusOr<std::vector<std::string>> takeCompleted();

 private:
  FolderWatch(std::filesystem::path folder, int inotify);
  void addPresent(std::filesystem::file_time_type since);

  const std::filesystem::path folder_;
  const int inotify_;
  bool is_gone_ = false;
  std::filesystem::file_time_type read_at_;  // when events were read last
  std::vector<std::string> completed_;
};

// Whether another process has the file open for writing, as far as this one may know it.
bool isBeingWritten(const std::filesystem::path& file);

}  // namespace viewloom::cli
