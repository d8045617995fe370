// SPDX-License-Identifier: Apache-2.0
// What a viewer or a still asks for, read from the parameters of a URL.
#pragma once

#include <string>

#include "base/status.h"
#include "display/display_spec.h"
#include "publish/stream_directory.h"
#include "web/url.h"

namespace viewloom {

struct WatchRequest {
  std::string stream;
  DisplaySpec display;  // completed; a quilt, or colour with depth
  EncodingSpec encoding;
};

// Parameters: stream, preset (default "portrait" when neither columns nor rows say otherwise),
// columns, rows, width, height, aspect, cone_deg, cone_begin, cone_end, focus_m, focus_follow_s,
// fov_deg, quality, chroma (420, 444), depth. Those of colour with depth: see rgbd_request.h.
// NOT_FOUND for an unknown stream or preset, INVALID_ARGUMENT for anything else, with the parameter
// as the field.
absl::StatusOr<WatchRequest> parseWatchRequest(const QueryParameters& parameters,
                                               const StreamDirectory& streams);

// "_qs8x6a0.75", with which the name of a quilt's still ends. "" for other displays.
absl::StatusOr<std::string> quiltSuffix(const DisplaySpec& display);

}  // namespace viewloom
