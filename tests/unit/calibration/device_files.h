// SPDX-License-Identifier: Apache-2.0
// Calibration files of real devices, as their owners published them.
#pragma once

#include <string>
#include <string_view>

namespace viewloom {

// A Portrait: three equal stripes a px, the empty list of cells spelt out.
extern const std::string_view kPortraitFile;
// A 16" of the third generation: two cells by column, keys that matter to nobody left out.
extern const std::string_view kThirdGenerationFile;

// The file with what stands for `from` changed to `to`; `from` must be there.
std::string edited(std::string_view file, std::string_view from, std::string_view to);

}  // namespace viewloom
