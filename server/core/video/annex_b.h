// SPDX-License-Identifier: Apache-2.0
// Parts of an H.264 byte stream (ITU-T H.264, annex B).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace viewloom {

// Values of nal_unit_type (table 7-1).
enum class NalType : uint8_t {
  kSlice = 1,
  kIdrSlice = 5,
  kSupplement = 6,
  kSequenceParameters = 7,
  kPictureParameters = 8,
  kDelimiter = 9,
};

// A unit without its start code. Borrowed bytes, of which the first holds the type.
struct NalUnit {
  std::span<const uint8_t> bytes;

  NalType type() const { return NalType(bytes.front() & 0x1F); }
};

// Units of any bytes, one after the other. Bytes before the first start code, and empty units, are
// left out. Borrows the bytes. Thread-safety: none.
class NalReader {
 public:
  explicit NalReader(std::span<const uint8_t> stream);
  // Nothing after the last unit.
  std::optional<NalUnit> next();

 private:
  std::span<const uint8_t> rest_;  // from a start code on; empty at the end
};

// All units of any bytes. They may take four times as much memory as the bytes.
std::vector<NalUnit> nalUnits(std::span<const uint8_t> stream);

}  // namespace viewloom
