// SPDX-License-Identifier: Apache-2.0
// A folder of files that lasts one test.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace viewloom::files {

// Makes an empty folder under the system's temporary one; removes it with everything in it.
class TestFolder {
 public:
  TestFolder();
  ~TestFolder();
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, std::string_view bytes) const;
  // The first count bytes of a file, as another file.
  std::filesystem::path truncated(const std::filesystem::path& file, size_t count) const;

 private:
  std::filesystem::path path_;
};

std::string bytesOf(const std::filesystem::path& file);

}  // namespace viewloom::files
