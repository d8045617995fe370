// SPDX-License-Identifier: Apache-2.0
// Sizes on the command line: "960x540".
#pragma once

#include <string>

#include "frame/size.h"
#include "usage/command_line.h"

namespace viewloom::cli {

// Adds an option that takes WxH, 1..side_max_px a side, into `size_px`.
usage::Option addSizeOption(const usage::Command& app, const std::string& name, SizePx& size_px,
                            uint32_t side_max_px, const std::string& description);

}  // namespace viewloom::cli
