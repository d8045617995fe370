// SPDX-License-Identifier: Apache-2.0
// Where a device's calibration comes from (a file, or the storage that the device plugs in as), and
// which of the server's named quilts suits it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "calibration/calibration.h"

namespace viewloom::show {

// LKG_calibration/visual.json on everything mounted below media, run/media and mnt, sorted. root:
// of the file system.
std::vector<std::filesystem::path> findCalibrationFiles(const std::filesystem::path& root);

// INVALID_ARGUMENT with the path and the key that is wrong.
absl::StatusOr<Calibration> readCalibrationFile(const std::filesystem::path& path);

// The named file; else the one that is found; else none. INVALID_ARGUMENT when there are several.
absl::StatusOr<std::optional<Calibration>> chooseCalibration(const std::string& named,
                                                             const std::filesystem::path& root);

// The named quilt of a calibrated device: by the serial number's prefix, else by the panel's size;
// "portrait" for a device nobody knows.
std::string_view presetOf(const Calibration& calibration);

}  // namespace viewloom::show
