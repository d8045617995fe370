// SPDX-License-Identifier: Apache-2.0
#include "containment/file_grants.h"

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "absl/strings/str_split.h"

namespace viewloom {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReadable[] = {
    "/usr", "/lib", "/lib32", "/lib64", "/opt", "/run/opengl-driver",
    // Not all of /etc: root could read all of it. Nor the private keys of other services: a group
    // for the server's own key may read them.
    "/etc/ld.so.cache", "/etc/ld.so.conf", "/etc/ld.so.conf.d", "/etc/vulkan", "/etc/glvnd",
    "/etc/drirc", "/etc/nvidia", "/etc/amd", "/etc/fonts", "/etc/ssl/certs", "/etc/ssl/openssl.cnf",
    "/etc/ca-certificates", "/etc/pki/ca-trust", "/etc/pki/tls/certs", "/etc/pki/tls/openssl.cnf",
    "/etc/hosts", "/etc/host.conf", "/etc/resolv.conf", "/etc/nsswitch.conf", "/etc/gai.conf",
    "/etc/services", "/etc/protocols", "/etc/localtime", "/etc/timezone", "/etc/passwd",
    "/etc/group", "/etc/viewloom",
    // The machine, and this process.
    "/proc/self", "/proc/cpuinfo", "/proc/meminfo", "/proc/stat", "/proc/loadavg",
    "/proc/filesystems", "/proc/version", "/proc/devices", "/proc/modules", "/proc/driver",
    "/proc/sys", "/proc/pressure", "/sys"};

constexpr const char* kDevices[] = {"/dev/dri",  "/dev/kfd",     "/dev/dxg",    "/dev/udmabuf",
                                    "/dev/null", "/dev/zero",    "/dev/random", "/dev/urandom",
                                    "/dev/shm",  "/dev/dma_heap"};

constexpr const char* kNvidiaDevice = "/dev/nvidiactl";

// Variables that name files or folders of drivers and layers, separated by colons.
constexpr const char* kDriverLists[] = {
    "VK_ICD_FILENAMES",   "VK_DRIVER_FILES",           "VK_ADD_DRIVER_FILES", "VK_LAYER_PATH",
    "VK_ADD_LAYER_PATH",  "VK_IMPLICIT_LAYER_PATH",    "LD_LIBRARY_PATH",     "LIBGL_DRIVERS_PATH",
    "LIBVA_DRIVERS_PATH", "VK_ADD_IMPLICIT_LAYER_PATH"};

std::vector<std::string> partsOf(const Environment& environment, const char* name) {
  return absl::StrSplit(environment(name).value_or(""), ':', absl::SkipEmpty());
}

// Folder of a user's files: the variable, else a folder below HOME; empty without both.
fs::path userFolder(const Environment& environment, const char* variable, const char* below_home) {
  if (const auto folder = environment(variable)) return *folder;
  const auto home = environment("HOME");
  return home ? fs::path(*home) / below_home : fs::path();
}

// Folder of the library that a manifest of a driver or layer names; empty for other files.
fs::path libraryFolder(const fs::path& manifest) {
  std::ifstream file(manifest);
  const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
  for (const char* kind : {"ICD", "layer"}) {
    if (!json.is_object() || !json.contains(kind) || !json[kind].is_object()) continue;
    const auto library = json[kind].find("library_path");
    if (library == json[kind].end() || !library->is_string()) continue;
    const fs::path path = library->get<std::string>();
    if (path.has_parent_path()) return (manifest.parent_path() / path).parent_path();
  }
  return {};
}

void addManifest(const fs::path& manifest, std::vector<FileGrant>& grants) {
  if (manifest.extension() != ".json") return;
  const fs::path folder = libraryFolder(manifest);
  if (!folder.empty()) grants.push_back({folder, FileAccess::kRead});
}

// A manifest or a folder of manifests, with the folders of their libraries.
void addDriver(const fs::path& path, std::vector<FileGrant>& grants) {
  grants.push_back({path, FileAccess::kRead});
  addManifest(path, grants);
  std::error_code error;
  for (fs::directory_iterator entry(path, error), end; !error && entry != end;
       entry.increment(error)) {
    addManifest(entry->path(), grants);
  }
}

// NVIDIA has a device file for each GPU.
void addNvidiaDevices(std::vector<FileGrant>& grants) {
  std::error_code error;
  for (fs::directory_iterator entry("/dev", error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().filename().string().starts_with("nvidia")) {
      grants.push_back({entry->path(), FileAccess::kDevice});
    }
  }
}

}  // namespace

std::optional<std::string> processVariable(const char* name) {
  const char* const value = std::getenv(name);
  if (value == nullptr || *value == '\0') return std::nullopt;
  return value;
}

std::vector<FileGrant> librariesGrants(const Environment& environment) {
  std::vector<FileGrant> grants;
  for (const char* path : kReadable) grants.push_back({path, FileAccess::kRead});
  for (const char* path : kDevices) grants.push_back({path, FileAccess::kDevice});
  addNvidiaDevices(grants);
  for (const char* list : kDriverLists) {
    for (const std::string& part : partsOf(environment, list)) addDriver(part, grants);
  }
  const auto add_user = [&](const char* variable, const char* below_home) {
    const fs::path folder = userFolder(environment, variable, below_home);
    if (folder.empty()) return;
    for (const char* kind : {"icd.d", "implicit_layer.d", "explicit_layer.d"}) {
      addDriver(folder / "vulkan" / kind, grants);
    }
  };
  add_user("XDG_DATA_HOME", ".local/share");
  add_user("XDG_CONFIG_HOME", ".config");
  if (const auto home = environment("HOME")) {
    grants.push_back({fs::path(*home) / ".drirc", FileAccess::kRead});
  }
  return grants;
}

std::vector<FileGrant> driverCacheGrants(const Environment& environment) {
  std::vector<FileGrant> grants;
  const auto add = [&grants](const fs::path& folder) {
    if (!folder.empty()) grants.push_back({folder, FileAccess::kKeep});
  };
  const fs::path cache = userFolder(environment, "XDG_CACHE_HOME", ".cache");
  if (const auto folder = environment("MESA_SHADER_CACHE_DIR")) {
    add(*folder);
  } else if (!cache.empty()) {
    add(cache / "mesa_shader_cache");
  }
  if (!fs::exists(kNvidiaDevice)) return grants;
  if (const auto folder = environment("__GL_SHADER_DISK_CACHE_PATH")) {
    add(*folder);
  } else if (!cache.empty()) {
    add(cache / "nvidia");
  }
  if (const auto home = environment("HOME")) add(fs::path(*home) / ".nv");
  return grants;
}

std::vector<FileGrant> replaceableFile(const fs::path& file) {
  std::error_code error;
  std::vector<FileGrant> grants;
  fs::path place = fs::absolute(file, error);
  // Tools that renew certificates chain a few links; a circle of links has no end.
  constexpr int kLinksMax = 8;
  for (int link = 0; link < kLinksMax; ++link) {
    grants.push_back({place.parent_path(), FileAccess::kRead});
    if (!fs::is_symlink(place, error)) break;
    place = place.parent_path() / fs::read_symlink(place, error);
  }
  return grants;
}

}  // namespace viewloom
