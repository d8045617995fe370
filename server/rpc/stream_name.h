// SPDX-License-Identifier: Apache-2.0
// What a stream may be called.
#pragma once

#include <string>
#include <string_view>

#include "base/status.h"

namespace viewloom {

// [A-Za-z0-9._-]{1,64}
absl::Status validateStreamName(const std::string& name, std::string_view field);

}  // namespace viewloom
