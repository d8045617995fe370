// SPDX-License-Identifier: Apache-2.0
// An option that takes one of a few words.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace viewloom::usage {

// Accepts these words only, and suggests the nearest of them to another.
CLI::Validator oneOf(std::vector<std::string> words);

}  // namespace viewloom::usage
