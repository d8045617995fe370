// SPDX-License-Identifier: Apache-2.0
// RGB of a view that lies in a cell of a decoded picture.
#pragma once

#include <cstddef>
#include <cstdint>

#include "video/video_picture.h"

namespace viewloom {

// Place of a view in a picture, px. The origin is even.
struct PictureCell {
  uint32_t x_px = 0;
  uint32_t y_px = 0;
  SizePx view_px;
};

// Writes the view as uint8_t[view height][x][3] R, G, B, with `stride_bytes` from row to row.
// Expects a view inside of the picture. Chroma is interpolated between its samples, as libjpeg does
// it, but not across the edges of the view: neighbours are other views. Throws std::bad_alloc.
void writeViewColors(const VideoPicture& picture, const PictureCell& cell, uint8_t* rgb,
                     size_t stride_bytes);
// The same as uint8_t[view height][x][4] R, G, B, 255.
void writeOpaqueColors(const VideoPicture& picture, const PictureCell& cell, uint8_t* rgba,
                       size_t stride_bytes);

}  // namespace viewloom
