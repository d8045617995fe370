// SPDX-License-Identifier: Apache-2.0
#include "mp4/box_writer.h"

#include <limits>

#include "base/check.h"

namespace viewloom {

void BoxWriter::set32(size_t offset, uint32_t value) {
  VIEWLOOM_CHECK(offset + sizeof(value) <= bytes_.size());
  for (size_t i = 0; i < sizeof(value); ++i) bytes_[offset + i] = uint8_t(value >> (24 - 8 * i));
}

size_t BoxWriter::beginBox(std::string_view type) {
  VIEWLOOM_CHECK(type.size() == 4);
  const size_t begin = bytes_.size();
  add32(0);
  addText(type);
  return begin;
}

void BoxWriter::endBox(size_t begin) {
  const size_t size_bytes = bytes_.size() - begin;
  VIEWLOOM_CHECK(size_bytes <= std::numeric_limits<uint32_t>::max());
  set32(begin, uint32_t(size_bytes));
}

}  // namespace viewloom
