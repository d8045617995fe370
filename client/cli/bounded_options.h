// SPDX-License-Identifier: Apache-2.0
// Options that take numbers and sizes within bounds, as the fields of proto Display that they stand
// for do.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "frame/size.h"
#include "usage/command_line.h"

namespace viewloom::cli {

// Adds an option that takes WxH, 1..side_max_px a side, into `size_px`.
usage::Option addSizeOption(const usage::Command& app, const std::string& name, SizePx& size_px,
                            uint32_t side_max_px, const std::string& description);

// The option accepts what a field of proto Display accepts when it is given. `field`: its path,
// "quilt.columns".
usage::Option within(const usage::Option& option, std::string_view field);
// The same, and all whole numbers from 0 on: for fields whose 0 has a meaning of its own.
usage::Option upTo(const usage::Option& option, std::string_view field);
uint32_t sideMax(std::string_view field);

}  // namespace viewloom::cli
