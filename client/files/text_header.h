// SPDX-License-Identifier: Apache-2.0
// Words of the text that PFM and PNM files begin with.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace viewloom::files {

// Words are separated by white space and by comments, which go from # to the end of the line.
class TextHeader {
 public:
  explicit TextHeader(std::span<const uint8_t> bytes) : bytes_(bytes) {}

  // Up to `length_max` characters; "" at the end of the file, or where a word is longer.
  std::string takeWord(size_t length_max = 32);
  // A whole number of up to nine digits; -1 where there is none.
  int64_t takeNumber();

  // Behind the last word.
  size_t offset() const { return offset_; }

 private:
  void skipSpace();

  std::span<const uint8_t> bytes_;
  size_t offset_ = 0;
};

bool isSpaceByte(uint8_t byte);

}  // namespace viewloom::files
