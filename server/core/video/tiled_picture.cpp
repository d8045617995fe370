// SPDX-License-Identifier: Apache-2.0
#include "video/tiled_picture.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/check.h"
#include "base/str_cat.h"
#include "shared/ycbcr.h"
#include "video/video_encoder.h"

namespace viewloom {
namespace {

uint32_t evenSide(double side_px) {
  return std::max(uint32_t(side_px) / 2 * 2, 2U);
}

SizePx grid(const AtlasTiles& atlas, SizePx tile_px) {
  return {atlas.columns * tile_px.width, atlas.rows * tile_px.height};
}

std::string text(SizePx size_px) {
  return strCat(size_px.width, "x", size_px.height, " px");
}

// Sides in 64 bits: the products of foreign ones fit.
absl::Status checkTiles(const AtlasTiles& atlas) {
  const uint64_t width_px = uint64_t{atlas.columns} * atlas.tile_px.width;
  const uint64_t height_px =
      uint64_t{atlas.rows} * atlas.tile_px.height + uint64_t{atlas.padding_top_px};
  const bool is_empty = atlas.columns == 0 || atlas.rows == 0 || atlas.tile_px.area() == 0;
  if (!is_empty && width_px <= atlas.atlas_px.width && height_px <= atlas.atlas_px.height) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(strCat(
      "an atlas of ", text(atlas.atlas_px), " does not hold ", atlas.columns, "x", atlas.rows,
      " views of ", text(atlas.tile_px), " below ", atlas.padding_top_px, " px of padding"));
}

// Two rows of colours as samples of 4:2:0, through the transform of JPEG files.
struct RowPair {
  const uint8_t* upper;
  const uint8_t* lower;
  uint8_t* upper_y;
  uint8_t* lower_y;
  uint8_t* cb;
  uint8_t* cr;
  uint32_t channel_count;

  void convert(uint32_t width_px) const {
    for (uint32_t x = 0; x < width_px; x += 2) {
      const uint32_t next = std::min(x + 1, width_px - 1);
      uint32_t cb_sum = 0;
      uint32_t cr_sum = 0;
      for (const auto& [row, y] : {Line{upper, upper_y}, Line{lower, lower_y}}) {
        for (const uint32_t at : {x, next}) {
          const uint8_t* const px = row + size_t{channel_count} * at;
          const auto red = float(px[0]), green = float(px[1]), blue = float(px[2]);
          y[at] = uint8_t(abi::lumaOf(red, green, blue));
          cb_sum += abi::cbOf(red, green, blue);
          cr_sum += abi::crOf(red, green, blue);
        }
      }
      cb[x / 2] = uint8_t(abi::meanChroma(cb_sum, x / 2));
      cr[x / 2] = uint8_t(abi::meanChroma(cr_sum, x / 2));
    }
  }

 private:
  struct Line {
    const uint8_t* colors;
    uint8_t* y;
  };
};

void copyRows(const std::vector<uint8_t>& from, SizePx from_px, uint8_t* to, size_t to_stride) {
  for (uint32_t y = 0; y < from_px.height; ++y) {
    std::memcpy(to + y * to_stride, &from[size_t{y} * from_px.width], from_px.width);
  }
}

}  // namespace

absl::StatusOr<VideoTiles> fitVideoTiles(const AtlasTiles& atlas, const PictureLimit& limit) {
  VIEWLOOM_RETURN_IF_ERROR(checkTiles(atlas));
  const double aspect = double(atlas.tile_px.height) / atlas.tile_px.width;
  for (uint32_t width = evenSide(atlas.tile_px.width); width >= 2; width -= 2) {
    const bool is_full = width + 1 >= atlas.tile_px.width;
    const double height = is_full ? atlas.tile_px.height : 2 * std::round(width * aspect / 2);
    const SizePx tile_px = {width, evenSide(height)};
    const SizePx picture_px = grid(atlas, tile_px);
    const bool is_smaller =
        tile_px.width <= atlas.tile_px.width && tile_px.height <= atlas.tile_px.height;
    if (!is_smaller || !limit.holds(picture_px)) continue;
    if (picture_px.width < kVideoSideMin_px || picture_px.height < kVideoSideMin_px) break;
    return VideoTiles{.tile_px = tile_px, .picture_px = picture_px};
  }
  return absl::ResourceExhaustedError(
      strCat("an atlas of ", text(atlas.atlas_px), " with ", atlas.columns, "x", atlas.rows,
             " views does not fit in a video; accepted are pictures from 16x16 px to ",
             limit.area_max_px, " px together. Choose fewer, or larger, views"));
}

std::string scalingNote(const AtlasTiles& atlas, const VideoTiles& video,
                        const PictureLimit& limit) {
  if (video.tile_px == atlas.tile_px) return "";
  return strCat("the atlas of ", text(grid(atlas, atlas.tile_px)), " is scaled to ",
                text(video.picture_px), ", because H.264 takes up to ", limit.area_max_px,
                " px and even views (", text(video.tile_px), " instead of ", text(atlas.tile_px),
                ")");
}

TiledPicture::Planes::Planes(SizePx size) : size_px(size), y(size.area()) {
  cb.resize(chromaSize().area());
  cr.resize(chromaSize().area());
}

TiledPicture::TiledPicture(const AtlasTiles& atlas, const VideoTiles& video)
    : atlas_(atlas), video_(video), tile_(atlas.tile_px), picture_(video.picture_px) {
  const SizePx to_px = video.tile_px;
  VIEWLOOM_CHECK(to_px.width <= atlas.tile_px.width && to_px.height <= atlas.tile_px.height);
  VIEWLOOM_CHECK(grid(atlas, atlas.tile_px).width <= atlas.atlas_px.width);
  VIEWLOOM_CHECK(grid(atlas, atlas.tile_px).height + atlas.padding_top_px <= atlas.atlas_px.height);
  if (to_px == atlas.tile_px) return;
  const double columns = double(atlas.tile_px.width) / to_px.width;
  const double rows = double(atlas.tile_px.height) / to_px.height;
  luma_scaler_.emplace(atlas.tile_px, to_px, columns, rows);
  chroma_scaler_.emplace(tile_.chromaSize(), SizePx{to_px.width / 2, to_px.height / 2}, columns,
                         rows);
}

uint64_t TiledPicture::memoryBytes(const AtlasTiles& atlas, const VideoTiles& video) {
  const uint64_t between_bytes = sizeof(float) * 2 * atlas.tile_px.area();
  return 2 * (atlas.tile_px.area() + video.picture_px.area()) + between_bytes;
}

VideoPicture TiledPicture::make(const AtlasColors& colors) {
  for (uint32_t row = 0; row < atlas_.rows; ++row) {
    for (uint32_t column = 0; column < atlas_.columns; ++column) {
      takeTile(colors, column * atlas_.tile_px.width,
               atlas_.padding_top_px + row * atlas_.tile_px.height);
      placeTile(column * video_.tile_px.width, row * video_.tile_px.height);
    }
  }
  const size_t chroma_stride = picture_.chromaSize().width;
  return {.size_px = picture_.size_px,
          .y = picture_.y.data(),
          .cb = picture_.cb.data(),
          .cr = picture_.cr.data(),
          .y_stride_bytes = picture_.size_px.width,
          .chroma_stride_bytes = chroma_stride};
}

void TiledPicture::takeTile(const AtlasColors& colors, uint32_t left_px, uint32_t top_px) {
  const SizePx size_px = tile_.size_px;
  const size_t stride = size_t{colors.channel_count} * atlas_.atlas_px.width;
  const size_t chroma_width = tile_.chromaSize().width;
  const uint8_t* const first =
      colors.samples + top_px * stride + size_t{colors.channel_count} * left_px;
  for (uint32_t y = 0; y < size_px.height; y += 2) {
    const uint32_t next = std::min(y + 1, size_px.height - 1);
    RowPair{.upper = first + y * stride,
            .lower = first + next * stride,
            .upper_y = &tile_.y[size_t{y} * size_px.width],
            .lower_y = &tile_.y[size_t{next} * size_px.width],
            .cb = &tile_.cb[y / 2 * chroma_width],
            .cr = &tile_.cr[y / 2 * chroma_width],
            .channel_count = colors.channel_count}
        .convert(size_px.width);
  }
}

void TiledPicture::placeTile(uint32_t left_px, uint32_t top_px) {
  const size_t stride = picture_.size_px.width;
  const size_t chroma_stride = picture_.chromaSize().width;
  uint8_t* const y = &picture_.y[top_px * stride + left_px];
  const size_t chroma_at = top_px / 2 * chroma_stride + left_px / 2;
  uint8_t* const cb = &picture_.cb[chroma_at];
  uint8_t* const cr = &picture_.cr[chroma_at];
  const SizePx chroma_px = tile_.chromaSize();
  if (!luma_scaler_) {
    copyRows(tile_.y, tile_.size_px, y, stride);
    copyRows(tile_.cb, chroma_px, cb, chroma_stride);
    copyRows(tile_.cr, chroma_px, cr, chroma_stride);
    return;
  }
  luma_scaler_->scale(tile_.y.data(), tile_.size_px.width, y, stride);
  chroma_scaler_->scale(tile_.cb.data(), chroma_px.width, cb, chroma_stride);
  chroma_scaler_->scale(tile_.cr.data(), chroma_px.width, cr, chroma_stride);
}

}  // namespace viewloom
