// SPDX-License-Identifier: Apache-2.0
// A small file that an operator may change while the server runs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/status.h"

namespace viewloom {

// The whole text of a regular file. FAILED_PRECONDITION names the path, the reason and the remedy.
absl::StatusOr<std::string> readSmallFile(const std::string& path, uint64_t bytes_max);

// Notices a change by the file's number, size and times. Thread-safety: none.
class WatchedFile {
 public:
  WatchedFile(std::string path, uint64_t bytes_max);

  const std::string& path() const { return path_; }
  // The text if the file is another than at the last call; empty if it is the same. A file that
  // cannot be read is an error once, and read as soon as it can be: the process may lack
  // descriptors for a moment.
  absl::StatusOr<std::optional<std::string>> readIfChanged();

 private:
  struct Mark {
    uint64_t device = 0;
    uint64_t number = 0;
    int64_t size = -1;  // -1 = there is no file
    int64_t modified_ns = 0;
    int64_t changed_ns = 0;
    friend bool operator==(const Mark&, const Mark&) = default;
  };
  Mark markNow() const;

  const std::string path_;
  const uint64_t bytes_max_;
  std::optional<Mark> seen_;
  bool is_unread_ = false;  // the file of that mark could not be read yet
};

}  // namespace viewloom
