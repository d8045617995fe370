// SPDX-License-Identifier: Apache-2.0
// DPT: depth of the MPI Sintel data set, binary32.
#pragma once

#include <span>
#include <string>

#include "files/picture.h"

namespace viewloom::files {

// Grey of floats, top row first. Optical flow (.flo), which begins with the same tag, is refused by
// its length. `name` is for messages.
absl::StatusOr<Picture> decodeDpt(const std::string& name, std::span<const uint8_t> bytes);

}  // namespace viewloom::files
