// SPDX-License-Identifier: Apache-2.0
// Options accept what the field of proto Display that they stand for accepts.
#pragma once

#include <cstdint>
#include <string_view>

#include "display/display_spec.h"
#include "usage/command_line.h"

namespace viewloom::cli {

// `field`: its path, "quilt.columns".
inline usage::Option within(const usage::Option& option, std::string_view field) {
  const Range range = rangeOf(field);
  return option.between(range.min, range.max);
}

inline uint32_t sideMax(std::string_view field) {
  return static_cast<uint32_t>(rangeOf(field).max);
}

}  // namespace viewloom::cli
