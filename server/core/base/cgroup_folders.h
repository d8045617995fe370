// SPDX-License-Identifier: Apache-2.0
// Folders with the limits of the cgroups that this process is in.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace viewloom {

struct CgroupFolder {
  std::filesystem::path path;
  int version = 2;  // 1 or 2: each names its files in its own way
};

// Folders of the cgroups of this process whose limits for a controller ("cpu", "memory") hold:
// its own and all around it. Some may not be there. `root` is where /proc and /sys are.
std::vector<CgroupFolder> cgroupFolders(const std::filesystem::path& root,
                                        std::string_view controller);

}  // namespace viewloom
