// SPDX-License-Identifier: Apache-2.0
// The display that a viewer, a still or a player watches: checked, with every default filled in.
#pragma once

#include <string>

#include "access/caller.h"
#include "base/status.h"
#include "display/display_spec.h"
#include "publish/stream_directory.h"
#include "web/url.h"

namespace viewloom {

struct AskedDisplay;

struct WatchRequest {
  std::string stream;
  DisplaySpec display;  // completed
  EncodingSpec encoding;
};

// The same conversion and checks as over gRPC, and those of what the web serves: one image, its
// colour as JPEG or H.264, its depth raw or compact. NOT_FOUND for an unknown preset,
// INVALID_ARGUMENT for anything else; errors name the field ("display.quilt.columns"). Whether
// there is such a stream is for checkStream to say.
absl::StatusOr<WatchRequest> makeWatchRequest(const AskedDisplay& asked);

// The same of what the parameters of a URL ask for; errors name the parameter.
absl::StatusOr<WatchRequest> makeWatchRequest(const QueryParameters& parameters);

// INVALID_ARGUMENT for a tracked display: whoever watches it has to send poses, as WebSockets do.
absl::Status checkUntracked(const DisplaySpec& display);

// NOT_FOUND for an unknown stream, with the names that there are for the caller.
absl::Status checkStream(const std::string& name, const Caller& caller,
                         const StreamDirectory& streams);

// "_qs8x6a0.75", with which the name of a quilt's still ends. "" for other displays.
absl::StatusOr<std::string> quiltSuffix(const DisplaySpec& display);

}  // namespace viewloom
