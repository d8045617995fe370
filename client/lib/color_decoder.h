// SPDX-License-Identifier: Apache-2.0
// Decodes the colour of atlases that may refer to each other.
#pragma once

#include <cstdint>
#include <memory>

#include "lib/atlas.h"

namespace viewloom {

class VideoDecoder;

// Chained video (PREDICTION_ACROSS_ATLASES) is one stream, which a decoder follows from atlas to
// atlas. Other atlases are decoded as by decodePlane.
// Thread-safety: none; one owner.
class ColorDecoder {
 public:
  ColorDecoder();
  ~ColorDecoder();
  ColorDecoder(ColorDecoder&&) noexcept;
  ColorDecoder& operator=(ColorDecoder&&) noexcept;

  // RGB, as decodePlane(atlas, COLOR). Takes the atlases of one call in the order in which they
  // came, each of them if they are chained. FAILED_PRECONDITION if the atlas refers to one that was
  // not decoded before it. After an error, atlases are refused until one comes that needs no other.
  absl::StatusOr<AtlasPicture> decode(const Atlas& atlas);

 private:
  absl::Status prepare(const Atlas& atlas);

  std::unique_ptr<VideoDecoder> decoder_;  // of the chain
  uint64_t sequence_ = 0;                  // of the last atlas; 0 = none
};

}  // namespace viewloom
