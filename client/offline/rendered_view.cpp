// SPDX-License-Identifier: Apache-2.0
#include "offline/rendered_view.h"

#include "encode/encoded_band.h"

namespace viewloom {
namespace {

PixelClass classOf(uint8_t ray_class) {
  switch (static_cast<RayClass>(ray_class)) {
    case RayClass::kHidden:
      return PixelClass::kHidden;
    case RayClass::kOutside:
      return PixelClass::kOutside;
    default:
      return PixelClass::kCovered;
  }
}

}  // namespace

RenderedView cutView(const RenderedAtlas& atlas, uint32_t view, ScoreTransfer transfer) {
  const AtlasLayout& layout = *atlas.layout;
  const TileOrigin origin = layout.tileOrigin(view);
  RenderedView cut = {.image = {.size_px = layout.tile_size_px, .rgb = {}}, .classes = {}};
  cut.image.rgb.reserve(3 * layout.tile_size_px.area());
  cut.classes.reserve(layout.tile_size_px.area());
  for (size_t y = 0; y < layout.tile_size_px.height; ++y) {
    for (size_t x = 0; x < layout.tile_size_px.width; ++x) {
      const size_t i = (origin.y_px + y) * layout.size_px.width + origin.x_px + x;
      for (size_t c = 0; c < 3; ++c) {
        cut.image.rgb.push_back(scoredSample(atlas.linear[4 * i + c], transfer));
      }
      cut.classes.push_back(classOf(atlas.mask[i]));
    }
  }
  return cut;
}

}  // namespace viewloom
