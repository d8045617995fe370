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

// The least limit of a cgroup and of those around it. In a container the path may be one of the
// host, of which only the mount point is there.
uint64_t leastLimit(const fs::path& mount, const std::string& group, const char* file) {
  uint64_t least_bytes = limitIn(mount / file);
  fs::path path = fs::path(group).relative_path();
  for (; !path.empty(); path = path.parent_path()) {
    least_bytes = std::min(least_bytes, limitIn(mount / path / file));
  }
  return least_bytes;
}

bool listsMemory(std::string_view controllers) {
  return ("," + std::string(controllers) + ",").find(",memory,") != std::string::npos;
}

// Lines of /proc/self/cgroup: "0::/user.slice" of version 2, "7:memory:/docker/ab12" of version 1.
uint64_t cgroupBytes(const fs::path& root) {
  const fs::path mount = root / "sys/fs/cgroup";
  uint64_t least_bytes = kUnlimited;
  std::ifstream stream(root / "proc/self/cgroup");
  for (std::string line; std::getline(stream, line);) {
    const size_t first = line.find(':');
    const size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const std::string group = line.substr(second + 1);
    if (controllers.empty()) {
      least_bytes = std::min(least_bytes, leastLimit(mount, group, "memory.max"));
    } else if (listsMemory(controllers)) {
      least_bytes =
          std::min(least_bytes, leastLimit(mount / "memory", group, "memory.limit_in_bytes"));
    }
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
