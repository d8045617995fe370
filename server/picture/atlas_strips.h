// SPDX-License-Identifier: Apache-2.0
// The strips that an atlas is made and packed in: rows of full width, each of one image.
#pragma once

#include <algorithm>
#include <cstdint>

#include "display/atlas_layout.h"
#include "display/video_stack.h"
#include "picture/trace_job.h"

namespace viewloom {

// Strips count through the images of the atlas, image by image, and in each from the top.
// Immutable.
class AtlasStrips {
 public:
  AtlasStrips() = default;
  // A strip has row_count rows, fewer only at the end of an image.
  AtlasStrips(const AtlasLayout& layout, uint32_t row_count,
              PictureOrder order = PictureOrder::kForward)
      : image_px_(layout.imageSize()),
        image_count_(layout.image_count),
        row_count_(row_count),
        per_image_((image_px_.height + row_count - 1) / row_count),
        order_(order) {}

  uint32_t perImage() const { return per_image_; }
  uint32_t count() const { return image_count_ * per_image_; }
  PictureOrder order() const { return order_; }
  uint32_t rowCountMax() const { return row_count_; }
  // Image at a place of their order, and the other way round.
  uint32_t imageAt(uint32_t place) const {
    return order_ == PictureOrder::kForward ? place : image_count_ - 1 - place;
  }
  // Place of a strip's image in their order.
  uint32_t placeOf(uint32_t strip) const { return strip / per_image_; }
  // In its image.
  uint32_t rowInImage(uint32_t strip) const { return strip % per_image_ * row_count_; }
  // In the atlas.
  BandRows rowsOf(uint32_t strip) const {
    const uint32_t row = rowInImage(strip);
    return {.first_row = imageAt(placeOf(strip)) * image_px_.height + row,
            .row_count = std::min(row_count_, image_px_.height - row)};
  }

 private:
  SizePx image_px_;
  uint32_t image_count_ = 0;
  uint32_t row_count_ = 0;
  uint32_t per_image_ = 1;
  PictureOrder order_ = PictureOrder::kForward;
};

}  // namespace viewloom
