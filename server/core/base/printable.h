// SPDX-License-Identifier: Apache-2.0
// Makes text from outside safe to print.
#pragma once

#include <string>
#include <string_view>

namespace viewloom {

// The text with every control character written as \x1b, and bytes that are no UTF-8 likewise: a
// terminal shows it and obeys nothing in it. Line breaks and tabs stay when `keeps_lines`.
std::string printable(std::string_view text, bool keeps_lines = false);

}  // namespace viewloom
