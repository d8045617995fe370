// SPDX-License-Identifier: Apache-2.0
// Stack of pictures in which the views of an atlas lie when their colour is video.
#pragma once

#include <cstdint>

#include "base/status.h"
#include "frame/size.h"

namespace viewloom {

// Pictures that a picture of a video may refer to.
enum class Prediction : uint8_t {
  kWithinAtlas,    // the one before in its atlas: each atlas can be decoded alone
  kAcrossAtlases,  // likewise; the first one to the last one of the atlas before
};

// Order in which the pictures of an atlas are made, coded and sent. Chained atlases turn it round
// each time: the first picture of an atlas then has the same views as the picture that it refers
// to.
enum class PictureOrder : uint8_t { kForward, kBackward };

// Place of a cell of a stack, from the top left.
struct StackCell {
  uint32_t picture = 0;
  uint32_t column = 0;
  uint32_t row = 0;
};

// Picture k holds the views k, k + picture_count, k + 2 picture_count, ... Cell by cell from the
// top left, rightwards, then downwards. So neighbouring views follow each other in time.
struct VideoStack {
  uint32_t view_count = 1;
  uint32_t picture_count = 1;
  uint32_t columns = 1;  // of cells in a picture
  uint32_t rows = 1;     // likewise
  SizePx cell_px;        // even; the view is at the top left of its cell

  SizePx pictureSize() const { return {columns * cell_px.width, rows * cell_px.height}; }
  StackCell cellOf(uint32_t view) const;
  // View in a cell; view_count if there is none.
  uint32_t viewAt(const StackCell& cell) const;

  bool operator==(const VideoStack&) const = default;
};

// Largest side of a picture: hardware decoders stop there.
inline constexpr SizePx kVideoPictureMax_px = {4096, 2176};

// Plans the stack of so many views of one size. Pictures have about a million pixels: smaller ones
// predict better, larger ones give decoders fewer calls. RESOURCE_EXHAUSTED if one view is larger
// than kVideoPictureMax_px.
absl::StatusOr<VideoStack> planVideoStack(SizePx view_px, uint32_t view_count);

// Memory that an encoder of such pictures takes, bytes; within a tenth.
uint64_t videoEncoderBytes(SizePx picture_px);
// Memory of the pictures of an atlas that wait to be coded.
uint64_t videoPicturesBytes(const VideoStack& stack);
// The same with an encoder.
uint64_t videoAtlasBytes(const VideoStack& stack);

}  // namespace viewloom
