// SPDX-License-Identifier: Apache-2.0
// PGM and PPM: grey and colour of whole numbers, as text or binary.
#pragma once

#include <span>
#include <string>

#include "files/picture.h"

namespace viewloom::files {

// P2, P3, P5 and P6 with a maximum of 1..65535, which stands for white; binary samples above 255
// are big endian. The first picture of several. `name` is for messages.
absl::StatusOr<Picture> decodePnm(const std::string& name, std::span<const uint8_t> bytes);

}  // namespace viewloom::files
