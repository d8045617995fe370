// SPDX-License-Identifier: Apache-2.0
// Makes text from outside safe to print.
#pragma once

#include <string>
#include <string_view>

namespace viewloom {

// Writes control characters, and bytes that are not UTF-8, as \x1b. A terminal then shows the text
// and obeys nothing in it. Line breaks and tabs stay with `keeps_lines`.
std::string printable(std::string_view text, bool keeps_lines = false);

}  // namespace viewloom
