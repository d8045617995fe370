// SPDX-License-Identifier: Apache-2.0
// Rules for the names of streams, and the error for an unknown one.
#pragma once

#include <string>
#include <string_view>

#include "access/caller.h"
#include "base/status.h"
#include "publish/stream_directory.h"

namespace viewloom {

// [A-Za-z0-9._-]{1,64}
absl::Status validateStreamName(const std::string& name, std::string_view field);

// NOT_FOUND, with the names that there are for the caller.
absl::Status noSuchStream(const std::string& name, std::string_view field,
                          const StreamDirectory& directory, const Caller& caller);

}  // namespace viewloom
