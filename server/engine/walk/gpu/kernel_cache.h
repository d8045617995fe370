// SPDX-License-Identifier: Apache-2.0
// A file in which a driver's compiled kernels stay from one start of the server to the next.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace viewloom {

// Drivers trust what they are given: a damaged file is taken for none. What cannot be written is
// logged once and then left: it costs time, nothing else. Thread-safety: none.
class KernelCache {
 public:
  explicit KernelCache(std::filesystem::path file) : file_(std::move(file)) {}

  // Empty where there is no such file, or it is damaged.
  std::vector<uint8_t> read();
  // In place of what the file holds, unless it holds the same. Makes its folder.
  void write(std::span<const uint8_t> kernels);

 private:
  const std::filesystem::path file_;
  uint64_t checksum_ = 0;  // of what it holds
  bool has_failed_ = false;
};

}  // namespace viewloom
