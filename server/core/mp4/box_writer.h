// SPDX-License-Identifier: Apache-2.0
// Writes nested boxes of ISO base media files (ISO 14496-12), big-endian.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace viewloom {

// Thread-safety: none.
class BoxWriter {
 public:
  void add8(uint8_t value) { bytes_.push_back(value); }
  void add16(uint16_t value) { addNumber(value, 2); }
  void add32(uint32_t value) { addNumber(value, 4); }
  void add64(uint64_t value) { addNumber(value, 8); }
  void addZeros(size_t count) { bytes_.resize(bytes_.size() + count); }
  void addText(std::string_view text) { bytes_.insert(bytes_.end(), text.begin(), text.end()); }
  void addBytes(std::span<const uint8_t> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  // Version and flags, with which a full box begins.
  void addVersion(uint8_t version, uint32_t flags = 0) { add32(uint32_t{version} << 24 | flags); }

  // A box with what `write_content()` writes in it. Expects a type of four characters, and less
  // than 4 GiB.
  template <typename Content>
  void addBox(std::string_view type, const Content& write_content) {
    const size_t begin = beginBox(type);
    write_content();
    endBox(begin);
  }

  size_t size() const { return bytes_.size(); }
  // Replaces four bytes that stand at `offset` already.
  void set32(size_t offset, uint32_t value);
  std::vector<uint8_t> take() { return std::move(bytes_); }

 private:
  void addNumber(uint64_t value, int byte_count) {
    for (int shift = 8 * (byte_count - 1); shift >= 0; shift -= 8) {
      bytes_.push_back(uint8_t(value >> shift));
    }
  }
  size_t beginBox(std::string_view type);
  void endBox(size_t begin);

  std::vector<uint8_t> bytes_;
};

}  // namespace viewloom
