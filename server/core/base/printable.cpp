// SPDX-License-Identifier: Apache-2.0
#include "base/printable.h"

#include <algorithm>
#include <cstdint>

namespace viewloom {
namespace {

// Bytes of the UTF-8 character that begins `text`; 0 when none does.
size_t utf8Length(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<uint8_t>(text[i]); };
  const uint8_t first = byte(0);
  if (first < 0x80) return 1;
  const size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  for (size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0U) != 0x80) return 0;
  }
  // Longer forms than needed, surrogates, beyond U+10FFFF.
  const uint8_t second = byte(1);
  const bool is_wrong = (first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) ||
                        (first == 0xf0 && second < 0x90) || (first == 0xf4 && second >= 0x90);
  return is_wrong ? 0 : length;
}

// Control characters, and marks that turn the direction of the text about them.
bool isControl(std::string_view character) {
  const auto first = static_cast<uint8_t>(character[0]);
  if (character.size() == 1) return first < 0x20 || first == 0x7f;
  const auto second = static_cast<uint8_t>(character[1]);
  if (character.size() == 2) return first == 0xc2 && second < 0xa0;
  const auto third = static_cast<uint8_t>(character[2]);
  if (first != 0xe2) return false;
  const bool is_embedding = second == 0x80 && third >= 0xa8 && third <= 0xae;
  const bool is_isolate = second == 0x81 && third >= 0xa6 && third <= 0xa9;
  return is_embedding || is_isolate;
}

}  // namespace

std::string printable(std::string_view text, bool keeps_lines) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const size_t length = utf8Length(text);
    const std::string_view character = firstCharacter(text);
    text.remove_prefix(character.size());
    const bool is_line = keeps_lines && (character == "\n" || character == "\t");
    if (is_line || (length != 0 && !isControl(character))) {
      shown += character;
      continue;
    }
    for (const char byte : character) {
      const auto code = static_cast<uint8_t>(byte);
      shown += {'\\', 'x', kDigits[code >> 4U], kDigits[code & 15U]};
    }
  }
  return shown;
}

std::string_view firstCharacter(std::string_view text) {
  return text.substr(0, std::max<size_t>(utf8Length(text), 1));
}

std::string_view wholeCharacters(std::string_view text, size_t bytes_max) {
  size_t end = 0;
  while (end < text.size()) {
    const size_t length = firstCharacter(text.substr(end)).size();
    if (end + length > bytes_max) break;
    end += length;
  }
  return text.substr(0, end);
}

std::string quotable(std::string_view text, size_t bytes_max) {
  const std::string_view begin = wholeCharacters(text, bytes_max);
  std::string shown = printable(begin);
  if (begin.size() < text.size()) shown += "...";
  return shown;
}

}  // namespace viewloom
