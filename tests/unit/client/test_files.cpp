// SPDX-License-Identifier: Apache-2.0
#include "unit/client/test_files.h"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace viewloom::files {

TestFolder::TestFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "viewloom_XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

TestFolder::~TestFolder() {
  std::filesystem::remove_all(path_);
}

std::filesystem::path TestFolder::write(const std::string& name, std::string_view bytes) const {
  const std::filesystem::path file = path_ / name;
  std::ofstream(file, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file;
}

std::filesystem::path TestFolder::truncated(const std::filesystem::path& file, size_t count) const {
  return write("truncated" + file.extension().string(), bytesOf(file).substr(0, count));
}

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace viewloom::files
