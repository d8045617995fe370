// SPDX-License-Identifier: Apache-2.0
// Whether a file shows all that a display looks at.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "display/views_outside.h"
#include "inspect/inspection.h"
#include "viewloom/v1/display.pb.h"

namespace viewloom::cli {

// Needs of the first source of a frame, between the 2nd and the 98th percentile of its first layer.
struct DisplayNeed {
  std::vector<ViewsOutside> outside;
  Fov wanted_fov;  // of a source in the same place that all views stay within
};

// Errors name the field of the display ("quilt.columns"). None of a cube map is outside.
absl::StatusOr<DisplayNeed> displayNeed(const v1::Display& display, const v1::Source& source,
                                        const inspect::SourceInspection& inspected);

// "past the edge of the source see views 0-6 by 4 %. They need ...", or that no view does.
std::string needText(const DisplayNeed& need);
nlohmann::json needJson(const DisplayNeed& need);

}  // namespace viewloom::cli
