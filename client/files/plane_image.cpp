// SPDX-License-Identifier: Apache-2.0
#include "files/plane_image.h"

#include "base/str_cat.h"
#include "files/file_bytes.h"

namespace viewloom::files {

absl::Status checkPlaneSize(const std::string& file, int64_t width_px, int64_t height_px) {
  if (width_px >= 1 && height_px >= 1 && width_px <= kSideMax_px && height_px <= kSideMax_px) {
    return absl::OkStatus();
  }
  return refuseFile(file, strCat("is ", width_px, "x", height_px, " px; accepted is 1..",
                                 kSideMax_px, " a side"));
}

}  // namespace viewloom::files
