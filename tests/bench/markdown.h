// SPDX-License-Identifier: Apache-2.0
// Whole reports as tables in markdown, as the README has them.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace viewloom::bench {

// {"loads", "ratios", "skipped"} as the program prints them: times, PSNR, visits and memory by
// load, then the targets, lost ones in bold.
std::string asMarkdown(const nlohmann::ordered_json& report);
// The targets alone.
std::string targetsAsMarkdown(const nlohmann::ordered_json& ratios);

}  // namespace viewloom::bench
