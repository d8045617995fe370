// SPDX-License-Identifier: Apache-2.0
#include "files/exr_unpack.h"

#include <zlib.h>

#include <algorithm>

#include "base/str_cat.h"

namespace viewloom::files {
namespace {

// Deflate gives at most 258 bytes for two bits; RLE 128 bytes for two.
constexpr uint64_t kExpansionMax = 1032;

bool inflate(std::span<const uint8_t> packed, std::vector<uint8_t>& unpacked) {
  uLongf size = unpacked.size();
  const int result = uncompress(unpacked.data(), &size, packed.data(), packed.size());
  return result == Z_OK && size == unpacked.size();
}

// A byte from 128 on is followed by 256 minus so many bytes as they are; a smaller one, by a byte
// that is repeated once more than it says.
bool unpackRuns(std::span<const uint8_t> packed, std::vector<uint8_t>& unpacked) {
  size_t from = 0;
  size_t to = 0;
  while (from < packed.size()) {
    const size_t code = packed[from++];
    const bool is_run = code < 128;
    const size_t length = is_run ? code + 1 : 256 - code;
    const size_t taken = is_run ? 1 : length;
    if (length > unpacked.size() - to || taken > packed.size() - from) return false;
    if (is_run) {
      std::fill_n(&unpacked[to], length, packed[from]);
    } else {
      std::copy_n(&packed[from], length, &unpacked[to]);
    }
    from += taken;
    to += length;
  }
  return to == unpacked.size();
}

// Both compressions take differences of neighbours, of the bytes at even places and then of those
// at odd ones.
void undoPrediction(std::vector<uint8_t>& bytes) {
  for (size_t i = 1; i < bytes.size(); ++i) {
    bytes[i] = static_cast<uint8_t>(bytes[i - 1] + bytes[i] - 128);
  }
  std::vector<uint8_t> in_place(bytes.size());
  const size_t half = (bytes.size() + 1) / 2;
  for (size_t i = 0; i < bytes.size(); ++i) {
    in_place[i] = bytes[i % 2 == 0 ? i / 2 : half + i / 2];
  }
  bytes.swap(in_place);
}

}  // namespace

std::string unpackExr(ExrCompression compression, std::span<const uint8_t> packed,
                      uint64_t unpacked_size, std::vector<uint8_t>& unpacked) {
  const bool is_stored = compression == ExrCompression::kNone;
  if (is_stored ? packed.size() != unpacked_size : packed.size() * kExpansionMax < unpacked_size) {
    return strCat(packed.size(), " bytes cannot be the ", unpacked_size, " wanted");
  }
  if (is_stored) {
    unpacked.assign(packed.begin(), packed.end());
    return "";
  }
  unpacked.resize(unpacked_size);
  const bool is_whole = compression == ExrCompression::kRle ? unpackRuns(packed, unpacked)
                                                            : inflate(packed, unpacked);
  if (!is_whole) {
    return strCat(packed.size(), " compressed bytes are not the ", unpacked_size, " wanted");
  }
  undoPrediction(unpacked);
  return "";
}

}  // namespace viewloom::files
