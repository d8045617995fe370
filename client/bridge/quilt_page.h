// SPDX-License-Identifier: Apache-2.0
// Asks the page of a viewloomd at which address a stream's quilt is.
#pragma once

#include <string>

#include "base/status.h"
#include "bridge/bridge.h"
#include "bridge/http_request.h"

namespace viewloom::bridge {

struct QuiltQuery {
  std::string stream;
  std::string display;     // a quilt, as JSON of proto Display
  std::string encoding;    // JSON of proto AtlasEncoding
  bool is_motion = false;  // motion JPEG instead of a still
  // Access token; empty = none. With one the address has a signed link, which is good for an hour.
  std::string token;
};

// Waits until there is an atlas to show. UNAVAILABLE where nobody listens, INVALID_ARGUMENT for a
// name that cannot be one, DEADLINE_EXCEEDED, CANCELLED, FAILED_PRECONDITION with the server's own
// words where it refuses. Thread-safety: may be called from any thread.
absl::StatusOr<AddressedQuilt> findQuilt(const HttpAddress& page, const QuiltQuery& query,
                                         const Patience& patience);

}  // namespace viewloom::bridge
