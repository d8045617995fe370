// SPDX-License-Identifier: Apache-2.0
// Files and folders that a contained server may use.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace viewloom {

enum class FileAccess : uint8_t {
  kRead,     // read files and list folders
  kKeep,     // also write, make, rename and remove files and folders
  kDevice,   // read, write and control devices (ioctl)
  kSockets,  // make and remove Unix sockets
  kLog       // make files and write them; neither read nor remove them
};

// One right. It holds for the path and, if that is a folder, for everything below.
struct FileGrant {
  std::filesystem::path path;
  FileAccess access = FileAccess::kRead;
};

// Value of an environment variable; nullopt when it is not set.
using Environment = std::function<std::optional<std::string>(const char* name)>;
std::optional<std::string> processVariable(const char* name);

// Files that libraries of the server read and write on any system: shared libraries, drivers of
// GPUs and their devices, certificates, fonts, names of hosts, the kernel's view of this process.
std::vector<FileGrant> librariesGrants(const Environment& environment);

// Folders in which drivers of this machine keep compiled kernels. A driver makes its folder at its
// first use, when it is too late for a right to it: make the folders before.
std::vector<FileGrant> driverCacheGrants(const Environment& environment);

// The right to read a file of the settings, such as a certificate, and what replaces it: a file is
// replaced by another one in its folder. Takes the folders of links, too.
std::vector<FileGrant> replaceableFile(const std::filesystem::path& file);

}  // namespace viewloom
