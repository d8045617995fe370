// SPDX-License-Identifier: Apache-2.0
// A file without a disk, for readers that take a path.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <span>

#include "base/check.h"
#include "base/str_cat.h"

namespace viewloom {

// Thread-safety: none.
class MemoryFile {
 public:
  explicit MemoryFile(std::span<const uint8_t> bytes) : file_(memfd_create("fuzz", MFD_CLOEXEC)) {
    VIEWLOOM_CHECK(file_ >= 0);
    VIEWLOOM_CHECK(write(file_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
  }
  ~MemoryFile() { close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  // A regular file, as long as this lives.
  std::filesystem::path path() const { return strCat("/proc/self/fd/", file_); }

 private:
  const int file_;
};

}  // namespace viewloom
