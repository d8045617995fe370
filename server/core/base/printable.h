// SPDX-License-Identifier: Apache-2.0
// Makes text from outside safe to print, and short enough to quote.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace viewloom {

// Writes control characters, and bytes that are not UTF-8, as \x1b. A terminal then shows the text
// and obeys nothing in it. Line breaks and tabs stay with `keeps_lines`.
std::string printable(std::string_view text, bool keeps_lines = false);

// Bytes of a text from outside that an error quotes: enough to find it again. A longer quotation
// would overflow the trailers of a call and fill logs.
inline constexpr size_t kQuotationBytesMax = 128;

// First UTF-8 character of a text that is not empty; its first byte where that begins none.
std::string_view firstCharacter(std::string_view text);

// Begin of a text, in whole UTF-8 characters, with at most that many bytes.
std::string_view wholeCharacters(std::string_view text, size_t bytes_max);

// Text from outside as errors quote it: printable, and "..." where it was cut.
std::string quotable(std::string_view text, size_t bytes_max = kQuotationBytesMax);

}  // namespace viewloom
