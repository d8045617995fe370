// SPDX-License-Identifier: Apache-2.0
// NPY: arrays of numpy as pictures.
#pragma once

#include <span>
#include <string>

#include "files/picture.h"

namespace viewloom::files {

// Versions 1 to 3, C or Fortran order, either byte order; floats of 16, 32 and 64 bits, whole
// numbers of 8 to 64. Shapes: (height, width), with 1 to 4 channels behind it or before it, and
// any ones in front. `name` is for messages.
absl::StatusOr<Picture> decodeNpy(const std::string& name, std::span<const uint8_t> bytes);

}  // namespace viewloom::files
