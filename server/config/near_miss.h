// SPDX-License-Identifier: Apache-2.0
// Which of several words somebody probably meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace viewloom {

// The candidate that takes fewest insertions, deletions and replacements to become `word`, or whose
// last part after a '.' is `word`; empty when none is near.
std::string nearMiss(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace viewloom
