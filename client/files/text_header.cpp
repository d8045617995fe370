// SPDX-License-Identifier: Apache-2.0
#include "files/text_header.h"

#include <algorithm>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"

namespace viewloom::files {

bool isSpaceByte(uint8_t byte) {
  return absl::ascii_isspace(byte);
}

void TextHeader::skipSpace() {
  while (offset_ < bytes_.size()) {
    if (bytes_[offset_] == '#') {
      while (offset_ < bytes_.size() && bytes_[offset_] != '\n' && bytes_[offset_] != '\r') {
        ++offset_;
      }
    } else if (isSpaceByte(bytes_[offset_])) {
      ++offset_;
    } else {
      return;
    }
  }
}

std::string TextHeader::takeWord(size_t length_max) {
  skipSpace();
  const auto rest = bytes_.subspan(offset_);
  const auto end = std::find_if(rest.begin(), rest.end(),
                                [](uint8_t byte) { return isSpaceByte(byte) || byte == '#'; });
  const auto length = static_cast<size_t>(end - rest.begin());
  if (length > length_max) return "";
  offset_ += length;
  return {rest.begin(), end};
}

int64_t TextHeader::takeNumber() {
  const std::string word = takeWord();
  const bool has_digits_alone =
      !word.empty() && word.size() <= 9 &&
      std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
  int64_t number = -1;
  return has_digits_alone && absl::SimpleAtoi(word, &number) ? number : -1;
}

}  // namespace viewloom::files
