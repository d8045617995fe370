// SPDX-License-Identifier: Apache-2.0
#include "show/find_calibration.h"

#include <algorithm>
#include <system_error>

#include "base/str_cat.h"
#include "files/file_bytes.h"

namespace viewloom::show {
namespace {

namespace fs = std::filesystem;

// Where desktops and people mount storage, and how many folders below that: user, label.
struct MountRoot {
  const char* folder;
  int depth;
};
constexpr MountRoot kMountRoots[] = {{"media", 1}, {"media", 2}, {"run/media", 2}, {"mnt", 1}};

// Folders that cannot be read are passed over: they are somebody else's.
std::vector<fs::path> foldersBelow(const fs::path& folder, int depth) {
  if (depth == 0) return {folder};
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code unreadable;
    if (!entry->is_directory(unreadable)) continue;
    const std::vector<fs::path> deeper = foldersBelow(entry->path(), depth - 1);
    found.insert(found.end(), deeper.begin(), deeper.end());
  }
  return found;
}

struct Device {
  std::string_view serial_prefix;
  SizePx screen_px;
  std::string_view preset;
};

// Looking Glass Factory's device templates. Panels of one size: the older device first.
constexpr Device kDevices[] = {
    {"LKG-2K", {2560, 1600}, "8_9_gen1"}, {"LKG-4K", {3840, 2160}, "15_6_gen1"},
    {"LKG-A", {3840, 2160}, "16_gen2"},   {"LKG-8K", {7680, 4320}, "8k_gen1"},
    {"LKG-B", {7680, 4320}, "32_gen2"},   {"LKG-P", {1536, 2048}, "portrait"},
    {"LKG-E", {1440, 2560}, "go_p"},      {"LKG-F", {1536, 2048}, "kiosk"},
    {"LKG-J", {3840, 2160}, "16_gen3_l"}, {"LKG-H", {2160, 3840}, "16_gen3_p"},
    {"LKG-L", {7680, 4320}, "32_gen3_l"}, {"LKG-K", {4320, 7680}, "32_gen3_p"},
    {"LKG-D", {7680, 4320}, "65"},
};

}  // namespace

std::vector<fs::path> findCalibrationFiles(const fs::path& root) {
  std::vector<fs::path> files;
  for (const MountRoot& mounts : kMountRoots) {
    for (const fs::path& folder : foldersBelow(root / mounts.folder, mounts.depth)) {
      const fs::path file = folder / "LKG_calibration" / "visual.json";
      std::error_code error;
      if (fs::is_regular_file(file, error)) files.push_back(file);
    }
  }
  std::ranges::sort(files);
  return files;
}

absl::StatusOr<Calibration> readCalibrationFile(const fs::path& path) {
  const absl::StatusOr<std::vector<uint8_t>> bytes =
      files::readFileBytes(path, kCalibrationBytesMax);
  if (!bytes.ok()) return bytes.status();
  absl::StatusOr<Calibration> calibration =
      parseCalibration({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
  if (calibration.ok()) return calibration;
  return files::refuseFile(path.string(), std::string(calibration.status().message()));
}

absl::StatusOr<std::optional<Calibration>> chooseCalibration(const std::string& named,
                                                             const fs::path& root) {
  std::vector<fs::path> files;
  if (named.empty()) {
    files = findCalibrationFiles(root);
  } else {
    files.emplace_back(named);
  }
  if (files.empty()) return std::nullopt;
  if (files.size() == 1) return readCalibrationFile(files.front());
  std::string list;
  for (const fs::path& file : files) list += strCat(list.empty() ? "" : ", ", file.string());
  return absl::InvalidArgumentError(
      strCat("there are several calibrations: ", list, "; name one with --calibration"));
}

std::string_view presetOf(const Calibration& calibration) {
  for (const Device& device : kDevices) {
    if (calibration.serial.starts_with(device.serial_prefix)) return device.preset;
  }
  for (const Device& device : kDevices) {
    if (calibration.screen_px == device.screen_px) return device.preset;
  }
  return "portrait";
}

}  // namespace viewloom::show
