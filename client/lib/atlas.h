// SPDX-License-Identifier: Apache-2.0
// A whole atlas as it was received. Its pictures are decoded on demand.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/status.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom {

// A full-width strip of an image, with its pieces joined.
struct AtlasBand {
  uint32_t image_index = 0;
  v1::AtlasPlane plane = v1::ATLAS_PLANE_COLOR;
  uint32_t first_row = 0;  // px from the top of its image
  uint32_t row_count = 0;
  v1::BandEncoding encoding = v1::BAND_ENCODING_JPEG;
  std::string bytes;
};

struct Atlas {
  std::shared_ptr<const v1::AtlasLayout> layout;
  v1::AtlasHeader header;
  v1::AtlasEnd end;
  std::vector<AtlasBand> bands;  // bands of a plane from the top; planes in any order

  size_t byteCount() const;
};

// Samples of one plane: uint8_t[height_px][width_px][channels], packed, top row first. For depth
// the channels are the four bytes of a binary32, for depth codes the two of a u16, little endian.
struct AtlasPicture {
  uint32_t width_px = 0;
  uint32_t height_px = 0;
  uint32_t channels = 0;
  std::vector<uint8_t> samples;
};

// Whether the bands of the plane cover every image of the atlas without gap or overlap.
bool hasWholePlane(const Atlas& atlas, v1::AtlasPlane plane);

// Returns a colour plane of one image as a JPEG file, with the bytes that the server encoded. The
// plane is COLOR, or for JPEG_PLANES one of RED, GREEN and BLUE, which are grey.
// FAILED_PRECONDITION if the server did not send that plane as JPEG.
absl::StatusOr<std::string> joinJpegBands(const Atlas& atlas,
                                          v1::AtlasPlane plane = v1::ATLAS_PLANE_COLOR,
                                          uint32_t image = 0);

// Decodes one plane of the whole atlas, with its images one below the other. COLOR becomes RGB,
// also from separate channels. RED, GREEN, BLUE and MASK become one byte a pixel, DEPTH_CODES two,
// DEPTH four. FAILED_PRECONDITION if the atlas has no such plane, or is chained video that refers
// to another (color_decoder.h). DATA_LOSS if its bytes do not decode to the size of the layout.
absl::StatusOr<AtlasPicture> decodePlane(const Atlas& atlas, v1::AtlasPlane plane);

// Top left corner of a view's tile in the atlas.
struct TilePlace {
  uint32_t left_px = 0;
  uint32_t top_px = 0;
};

// Expects view < layout.view_count().
TilePlace placeOfView(const v1::AtlasLayout& layout, uint32_t view);

// Cuts one view out of a decoded plane, by the order, columns and tile size of the layout.
AtlasPicture cutView(const AtlasPicture& picture, const v1::AtlasLayout& layout, uint32_t view);

}  // namespace viewloom
