// SPDX-License-Identifier: Apache-2.0
// An inspected frame for people and for machines.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/frame_loader.h"
#include "cli/inspected_display.h"
#include "inspect/inspection.h"

namespace viewloom::cli {

struct InspectedFile {
  std::string file;
  std::string format;  // "OpenEXR, 1 part, channels R (half), ..."
  LoadedFiles loaded;
  std::vector<inspect::SourceInspection> sources;
  bool camera_is_assumed = false;
  std::optional<DisplayNeed> need;  // of a display, where one was named
};

// Description of the file itself, before its planes are read.
absl::StatusOr<std::string> describeFormat(const std::string& file);

// "kind: what was seen; the remedy".
std::string warningText(const inspect::Suspicion& suspicion);

// Several lines, each ended. What names in files hold beside text is shown as codes.
std::string reportText(const InspectedFile& inspected);

nlohmann::json reportJson(const InspectedFile& inspected);
// In ASCII, whatever bytes the names in it hold.
std::string jsonText(const nlohmann::json& json);

}  // namespace viewloom::cli
