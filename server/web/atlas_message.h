// SPDX-License-Identifier: Apache-2.0
// One atlas as one binary WebSocket message: the length of a JSON header (4 bytes, little-endian),
// the header, the atlas as one baseline JPEG or as pictures of H.264, and the bands of its depth
// where that was asked for.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "encode/encoded_band.h"

namespace viewloom {

// Facts that only this viewer's connection knows.
struct Delivery {
  uint64_t delivery = 0;       // counts what this viewer is sent, from 1
  uint64_t change_count = 0;   // changes that this viewer had asked for by then, also in vain
  uint64_t dropped_count = 0;  // atlases of its display this viewer did not get, since it came
  int64_t mailbox_ns = 0;      // that this atlas waited for the viewer
  int64_t shown_ns = 0;  // from writing an atlas to its acknowledgement; the newest known, 0 = none
};

// Holds the atlas, whose bytes it does not copy. parts() point into the message: it must not move.
class AtlasMessage {
 public:
  AtlasMessage(AtlasPtr atlas, const Delivery& delivery);
  AtlasMessage(const AtlasMessage&) = delete;
  AtlasMessage& operator=(const AtlasMessage&) = delete;

  // In the order in which they are written.
  const std::vector<std::span<const uint8_t>>& parts() const { return parts_; }
  uint64_t sizeBytes() const;

 private:
  AtlasPtr atlas_;
  std::string header_;
  std::array<uint8_t, 4> header_length_;
  std::vector<std::span<const uint8_t>> parts_;
};

// Bands of the color. Joined, they are one JPEG, or a stream of H.264 in which each is a picture.
std::vector<SharedBytes> colorBands(const EncodedAtlas& atlas);

}  // namespace viewloom
