// SPDX-License-Identifier: Apache-2.0
#include "base/cgroup_folders.h"

#include <fstream>
#include <string>

namespace viewloom {
namespace {

namespace fs = std::filesystem;

// In a container the group may be one of the host, of which only the mount point is there. A group
// outside the namespace of the process begins with "..", and cannot be seen either.
void addGroups(const fs::path& mount, const std::string& group, int version,
               std::vector<CgroupFolder>& folders) {
  folders.push_back({mount, version});
  if (group == "/.." || group.starts_with("/../")) return;
  for (fs::path path = fs::path(group).relative_path(); !path.empty(); path = path.parent_path()) {
    folders.push_back({mount / path, version});
  }
}

bool listsController(const std::string& controllers, std::string_view controller) {
  return ("," + controllers + ",").find("," + std::string(controller) + ",") != std::string::npos;
}

}  // namespace

// Lines of /proc/self/cgroup: "0::/user.slice" of version 2, "7:cpu,cpuacct:/docker/ab12" of
// version 1.
std::vector<CgroupFolder> cgroupFolders(const fs::path& root, std::string_view controller) {
  const fs::path mount = root / "sys/fs/cgroup";
  std::vector<CgroupFolder> folders;
  std::ifstream stream(root / "proc/self/cgroup");
  for (std::string line; std::getline(stream, line);) {
    const size_t first = line.find(':');
    const size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const std::string group = line.substr(second + 1);
    if (controllers.empty()) {
      addGroups(mount, group, 2, folders);
    } else if (listsController(controllers, controller)) {
      addGroups(mount / controller, group, 1, folders);
      // Not every system has a link of the controller's own name.
      if (controllers != controller) addGroups(mount / controllers, group, 1, folders);
    }
  }
  return folders;
}

}  // namespace viewloom
