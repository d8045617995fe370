// SPDX-License-Identifier: Apache-2.0
#include "lib/atlas.h"

#include <turbojpeg.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>

#include "base/check.h"
#include "base/str_cat.h"
#include "lib/stacked_atlas.h"

namespace viewloom {
namespace {

std::string nameOf(v1::AtlasPlane plane) {
  return v1::AtlasPlane_Name(plane);
}

absl::Status missing(v1::AtlasPlane plane) {
  return absl::FailedPreconditionError(
      strCat("the atlas has no whole ", nameOf(plane), "; it has to be asked for"));
}

std::vector<const AtlasBand*> bandsOf(const Atlas& atlas, v1::AtlasPlane plane, uint32_t image) {
  std::vector<const AtlasBand*> bands;
  for (const AtlasBand& band : atlas.bands) {
    if (band.plane == plane && band.image_index == image) bands.push_back(&band);
  }
  return bands;
}

// Servers that know of one image alone leave the count out. Pictures of a stack are images, too.
uint32_t imageCount(const Atlas& atlas) {
  if (atlas.layout->has_video()) return atlas.layout->video().picture_count();
  return std::max(atlas.layout->image_count(), 1u);
}

uint32_t imageHeight(const Atlas& atlas) {
  if (atlas.layout->has_video()) return atlas.layout->video().picture_size().height();
  return atlas.layout->size().height() / imageCount(atlas);
}

uint32_t imageWidth(const Atlas& atlas) {
  if (atlas.layout->has_video()) return atlas.layout->video().picture_size().width();
  return atlas.layout->size().width();
}

constexpr v1::AtlasPlane kChannelPlanes[] = {v1::ATLAS_PLANE_RED, v1::ATLAS_PLANE_GREEN,
                                             v1::ATLAS_PLANE_BLUE};

bool isJpeg(v1::BandEncoding encoding) {
  return encoding == v1::BAND_ENCODING_JPEG || encoding == v1::BAND_ENCODING_JPEG_PLANES;
}

uint32_t channelsOf(v1::AtlasPlane plane) {
  if (plane == v1::ATLAS_PLANE_COLOR) return 3;
  if (plane == v1::ATLAS_PLANE_DEPTH_CODES) return 2;
  return plane == v1::ATLAS_PLANE_DEPTH ? 4 : 1;
}

// Decodes one image into its rows of the picture. A JPEG has samples of one byte, one or three a
// px.
absl::Status decodeJpeg(const std::string& jpeg, uint32_t image, uint32_t image_height,
                        AtlasPicture& picture) {
  if (picture.channels != 1 && picture.channels != 3) {
    return absl::DataLossError("a plane came as JPEG that holds neither colour nor grey");
  }
  const std::unique_ptr<void, int (*)(void*)> handle(tjInitDecompress(), &tjDestroy);
  const auto* bytes = reinterpret_cast<const unsigned char*>(jpeg.data());
  int width = 0, height = 0, subsampling = 0, color_space = 0;
  if (tjDecompressHeader3(handle.get(), bytes, jpeg.size(), &width, &height, &subsampling,
                          &color_space) != 0 ||
      width != static_cast<int>(picture.width_px) || height != static_cast<int>(image_height)) {
    return absl::DataLossError(strCat("the JPEG is ", width, "x", height, " px; the layout says ",
                                      picture.width_px, "x", image_height));
  }
  const size_t image_bytes = size_t{picture.width_px} * image_height * picture.channels;
  if (tjDecompress2(handle.get(), bytes, jpeg.size(), &picture.samples[image * image_bytes], width,
                    0, height, picture.channels == 1 ? TJPF_GRAY : TJPF_RGB,
                    TJFLAG_STOPONWARNING) != 0) {
    return absl::DataLossError(tjGetErrorStr2(handle.get()));
  }
  return absl::OkStatus();
}

absl::Status unpackBand(const AtlasBand& band, uint8_t* out, size_t size) {
  if (band.encoding == v1::BAND_ENCODING_H264) {
    return absl::DataLossError("a band came as H.264 where the layout says no stack of pictures");
  }
  if (band.encoding == v1::BAND_ENCODING_RAW) {
    if (band.bytes.size() != size) {
      return absl::DataLossError(strCat("band at row ", band.first_row, " has ", band.bytes.size(),
                                        " bytes; expected ", size));
    }
    std::memcpy(out, band.bytes.data(), size);
    return absl::OkStatus();
  }
  if (band.encoding != v1::BAND_ENCODING_ZSTD) {
    return absl::UnimplementedError(
        strCat("the band at row ", band.first_row, " is ", v1::BandEncoding_Name(band.encoding),
               "; this client unpacks planes of ZSTD and RAW: ask for one of them"));
  }
  const size_t got = ZSTD_decompress(out, size, band.bytes.data(), band.bytes.size());
  if (ZSTD_isError(got) != 0 || got != size) {
    return absl::DataLossError(
        strCat("band at row ", band.first_row, " does not inflate to ", size, " bytes"));
  }
  return absl::OkStatus();
}

}  // namespace

size_t Atlas::byteCount() const {
  size_t count = 0;
  for (const AtlasBand& band : bands) count += band.bytes.size();
  return count;
}

bool hasWholePlane(const Atlas& atlas, v1::AtlasPlane plane) {
  for (uint32_t image = 0; image < imageCount(atlas); ++image) {
    uint64_t next_row = 0;
    for (const AtlasBand* band : bandsOf(atlas, plane, image)) {
      if (band->first_row != next_row) return false;
      next_row += band->row_count;
    }
    if (next_row == 0 || next_row != imageHeight(atlas)) return false;
  }
  return true;
}

absl::StatusOr<std::string> joinJpegBands(const Atlas& atlas, v1::AtlasPlane plane,
                                          uint32_t image) {
  if (!hasWholePlane(atlas, plane) || image >= imageCount(atlas)) return missing(plane);
  std::string jpeg;
  for (const AtlasBand* band : bandsOf(atlas, plane, image)) {
    if (!isJpeg(band->encoding)) {
      return absl::FailedPreconditionError("the colour of the atlas did not come as JPEG");
    }
    jpeg += band->bytes;
  }
  return jpeg;
}

namespace {

absl::Status decodeImage(const Atlas& atlas, v1::AtlasPlane plane, uint32_t image,
                         AtlasPicture& picture) {
  const std::vector<const AtlasBand*> bands = bandsOf(atlas, plane, image);
  if (isJpeg(bands.front()->encoding)) {
    const absl::StatusOr<std::string> jpeg = joinJpegBands(atlas, plane, image);
    if (!jpeg.ok()) return jpeg.status();
    return decodeJpeg(*jpeg, image, imageHeight(atlas), picture);
  }
  const size_t row_bytes = size_t{picture.width_px} * picture.channels;
  const size_t first_row = size_t{image} * imageHeight(atlas);
  for (const AtlasBand* band : bands) {
    VIEWLOOM_RETURN_IF_ERROR(unpackBand(*band,
                                        &picture.samples[row_bytes * (first_row + band->first_row)],
                                        row_bytes * band->row_count));
  }
  return absl::OkStatus();
}

absl::StatusOr<AtlasPicture> joinChannels(const Atlas& atlas) {
  AtlasPicture joined{.width_px = atlas.layout->size().width(),
                      .height_px = atlas.layout->size().height(),
                      .channels = 3,
                      .samples = {}};
  joined.samples.resize(size_t{3} * joined.width_px * joined.height_px);
  for (size_t channel = 0; channel < 3; ++channel) {
    const absl::StatusOr<AtlasPicture> grey = decodePlane(atlas, kChannelPlanes[channel]);
    if (!grey.ok()) return grey.status();
    for (size_t i = 0; i < grey->samples.size(); ++i) {
      joined.samples[3 * i + channel] = grey->samples[i];
    }
  }
  return joined;
}

}  // namespace

absl::StatusOr<AtlasPicture> decodePlane(const Atlas& atlas, v1::AtlasPlane plane) {
  if (plane == v1::ATLAS_PLANE_COLOR && hasWholePlane(atlas, v1::ATLAS_PLANE_RED)) {
    return joinChannels(atlas);
  }
  if (!hasWholePlane(atlas, plane)) return missing(plane);
  if (plane == v1::ATLAS_PLANE_COLOR && isWholeVideo(atlas)) return decodeVideo(atlas);
  const v1::AtlasLayout& layout = *atlas.layout;
  AtlasPicture picture{.width_px = imageWidth(atlas),
                       .height_px = imageCount(atlas) * imageHeight(atlas),
                       .channels = channelsOf(plane),
                       .samples = {}};
  picture.samples.resize(size_t{picture.width_px} * picture.channels * picture.height_px);
  for (uint32_t image = 0; image < imageCount(atlas); ++image) {
    VIEWLOOM_RETURN_IF_ERROR(decodeImage(atlas, plane, image, picture));
  }
  return layout.has_video() ? unstack(picture, layout) : picture;
}

TilePlace placeOfView(const v1::AtlasLayout& layout, uint32_t view) {
  VIEWLOOM_CHECK(view < layout.view_count());
  const uint32_t column = view % layout.columns();
  const uint32_t row_in_order = view / layout.columns();
  const bool from_bottom = layout.order() == v1::TILE_ORDER_BOTTOM_LEFT;
  const uint32_t row = from_bottom ? layout.rows() - 1 - row_in_order : row_in_order;
  return {.left_px = column * layout.tile_size().width(),
          .top_px = layout.padding_top_px() + row * layout.tile_size().height()};
}

AtlasPicture cutView(const AtlasPicture& picture, const v1::AtlasLayout& layout, uint32_t view) {
  AtlasPicture cut{.width_px = layout.tile_size().width(),
                   .height_px = layout.tile_size().height(),
                   .channels = picture.channels,
                   .samples = {}};
  const TilePlace place = placeOfView(layout, view);
  const size_t x = place.left_px;
  const size_t y = place.top_px;
  VIEWLOOM_CHECK(x + cut.width_px <= picture.width_px && y + cut.height_px <= picture.height_px);
  const size_t cut_row_bytes = size_t{cut.width_px} * cut.channels;
  for (size_t i = 0; i < cut.height_px; ++i) {
    const auto begin = picture.samples.begin() +
                       static_cast<std::ptrdiff_t>(((y + i) * picture.width_px + x) * cut.channels);
    cut.samples.insert(cut.samples.end(), begin,
                       begin + static_cast<std::ptrdiff_t>(cut_row_bytes));
  }
  return cut;
}

}  // namespace viewloom
