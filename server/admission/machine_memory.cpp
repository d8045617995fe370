// SPDX-License-Identifier: Apache-2.0
#include "admission/machine_memory.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "base/cgroup_folders.h"

namespace viewloom {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kUnlimited = std::numeric_limits<uint64_t>::max();

std::optional<uint64_t> parseNumber(std::string_view text) {
  uint64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() ? std::optional(value) : std::nullopt;
}

// A file of one number; "max", and a file that is not there, are no limit.
uint64_t limitIn(const fs::path& file) {
  std::ifstream stream(file);
  std::string word;
  stream >> word;
  return parseNumber(word).value_or(kUnlimited);
}

uint64_t installedBytes(const fs::path& root) {
  std::ifstream stream(root / "proc/meminfo");
  for (std::string name; stream >> name;) {
    uint64_t kibibytes = 0;
    if (name == "MemTotal:" && stream >> kibibytes) return kibibytes << 10;
    std::getline(stream, name);
  }
  return kUnlimited;
}

uint64_t cgroupBytes(const fs::path& root) {
  uint64_t least_bytes = kUnlimited;
  for (const CgroupFolder& folder : cgroupFolders(root, "memory")) {
    const char* const file = folder.version == 2 ? "memory.max" : "memory.limit_in_bytes";
    least_bytes = std::min(least_bytes, limitIn(folder.path / file));
  }
  return least_bytes;
}

struct Resident {
  uint64_t all_bytes = 0;
  uint64_t of_files_bytes = 0;
};

Resident readResident() {
  std::ifstream stream("/proc/self/statm");
  uint64_t all_pages = 0;
  uint64_t resident_pages = 0;
  uint64_t file_pages = 0;
  if (!(stream >> all_pages >> resident_pages >> file_pages)) return {};
  const auto page_bytes = uint64_t(::sysconf(_SC_PAGESIZE));
  return {.all_bytes = resident_pages * page_bytes, .of_files_bytes = file_pages * page_bytes};
}

}  // namespace

uint64_t machineMemoryBytes(const fs::path& root) {
  const uint64_t bytes = std::min(installedBytes(root), cgroupBytes(root));
  return bytes == kUnlimited ? 0 : bytes;
}

uint64_t residentBytes() {
  return readResident().all_bytes;
}

uint64_t ownResidentBytes() {
  const Resident resident = readResident();
  return resident.all_bytes - resident.of_files_bytes;
}

}  // namespace viewloom
