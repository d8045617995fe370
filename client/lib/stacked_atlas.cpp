// SPDX-License-Identifier: Apache-2.0
#include "lib/stacked_atlas.h"

#include <algorithm>
#include <memory>
#include <span>

#include "base/check.h"
#include "base/str_cat.h"
#include "video/openh264_decoder.h"
#include "video/video_encoder.h"
#include "video/view_colors.h"

namespace viewloom {
namespace {

SizePx sizeOf(const v1::SizePx& proto) {
  return {proto.width(), proto.height()};
}

// Top left corner of a cell of a picture.
struct CellPlace {
  uint32_t x_px = 0;
  uint32_t y_px = 0;
};

CellPlace placeOfCell(const v1::VideoStack& stack, uint32_t view) {
  const uint32_t cell = view / stack.picture_count();
  return {.x_px = cell % stack.columns() * stack.cell_size().width(),
          .y_px = cell / stack.columns() * stack.cell_size().height()};
}

AtlasPicture emptyAtlas(const v1::AtlasLayout& layout, uint32_t channels) {
  AtlasPicture picture{.width_px = layout.size().width(),
                       .height_px = layout.size().height(),
                       .channels = channels,
                       .samples = {}};
  picture.samples.resize(size_t{picture.width_px} * picture.height_px * channels);
  return picture;
}

// Place of a view's first sample.
size_t firstSample(const AtlasPicture& picture, const TilePlace& place) {
  return (size_t{place.top_px} * picture.width_px + place.left_px) * picture.channels;
}

// Writes the views that lie in one picture.
void writeViews(const VideoPicture& decoded, const v1::AtlasLayout& layout, uint32_t index,
                AtlasPicture& picture) {
  const v1::VideoStack& stack = layout.video();
  const size_t stride_bytes = size_t{picture.width_px} * picture.channels;
  for (uint32_t view = index; view < layout.view_count(); view += stack.picture_count()) {
    const CellPlace cell = placeOfCell(stack, view);
    writeViewColors(
        decoded, {.x_px = cell.x_px, .y_px = cell.y_px, .view_px = sizeOf(layout.tile_size())},
        &picture.samples[firstSample(picture, placeOfView(layout, view))], stride_bytes);
  }
}

absl::Status asLoss(uint32_t index, const absl::Status& status) {
  if (absl::IsResourceExhausted(status)) return status;
  return absl::DataLossError(strCat("picture ", index, " of the atlas: ", status.message()));
}

// The pictures by their numbers.
std::vector<const AtlasBand*> picturesOf(const Atlas& atlas) {
  std::vector<const AtlasBand*> pictures(atlas.layout->video().picture_count(), nullptr);
  for (const AtlasBand& band : atlas.bands) {
    const bool is_picture =
        band.plane == v1::ATLAS_PLANE_COLOR && band.image_index < pictures.size();
    if (is_picture) pictures[band.image_index] = &band;
  }
  return pictures;
}

}  // namespace

absl::Status checkStack(const v1::AtlasLayout& layout) {
  const v1::VideoStack& stack = layout.video();
  const SizePx cell_px = sizeOf(stack.cell_size());
  const SizePx picture_px = sizeOf(stack.picture_size());
  const uint64_t cells = uint64_t{stack.columns()} * stack.rows();
  const bool holds_views = stack.picture_count() > 0 &&
                           stack.picture_count() <= std::max(layout.view_count(), 1U) &&
                           cells > 0 && cells <= kVideoAreaMax_px && layout.view_count() > 0 &&
                           (layout.view_count() - 1) / stack.picture_count() < cells;
  const bool is_even = cell_px.width % 2 == 0 && cell_px.height % 2 == 0;
  const bool holds_cells = is_even && cell_px.width >= layout.tile_size().width() &&
                           cell_px.height >= layout.tile_size().height() &&
                           layout.tile_size().width() > 0 && layout.tile_size().height() > 0 &&
                           picture_px.area() <= kVideoAreaMax_px &&
                           uint64_t{stack.columns()} * cell_px.width == picture_px.width &&
                           uint64_t{stack.rows()} * cell_px.height == picture_px.height;
  // Small views have larger cells, but never so many.
  constexpr uint64_t kStackAreaMax_px = uint64_t{1} << 29;
  const bool is_bounded = picture_px.area() * stack.picture_count() <= kStackAreaMax_px;
  if (holds_views && holds_cells && is_bounded) return absl::OkStatus();
  return absl::DataLossError("the layout has a stack of pictures that does not hold its views");
}

bool isWholeVideo(const Atlas& atlas) {
  return atlas.layout->has_video() && hasWholePlane(atlas, v1::ATLAS_PLANE_COLOR) &&
         std::ranges::all_of(atlas.bands, [](const AtlasBand& band) {
           return band.plane != v1::ATLAS_PLANE_COLOR || band.encoding == v1::BAND_ENCODING_H264;
         });
}

absl::Status refusedReference(const Atlas& atlas) {
  return absl::FailedPreconditionError(strCat(
      "atlas ", atlas.header.sequence(), " refers to atlas ", atlas.header.reference_sequence(),
      ", which was not decoded before it; decode all atlases in their order with one "
      "ColorDecoder, or ask for PREDICTION_WITHIN_ATLAS"));
}

absl::StatusOr<AtlasPicture> decodeVideo(const Atlas& atlas) {
  if (atlas.header.reference_sequence() != 0) return refusedReference(atlas);
  const absl::StatusOr<std::unique_ptr<OpenH264Decoder>> decoder = OpenH264Decoder::make();
  VIEWLOOM_RETURN_IF_ERROR(decoder.status());
  return decodeVideo(atlas, **decoder);
}

absl::StatusOr<AtlasPicture> decodeVideo(const Atlas& atlas, VideoDecoder& decoder) {
  const v1::AtlasLayout& layout = *atlas.layout;
  AtlasPicture picture = emptyAtlas(layout, 3);
  const std::vector<const AtlasBand*> pictures = picturesOf(atlas);
  const auto count = uint32_t(pictures.size());
  for (uint32_t place = 0; place < count; ++place) {
    const uint32_t index = atlas.header.is_backward() ? count - 1 - place : place;
    VIEWLOOM_CHECK(pictures[index] != nullptr);
    const std::string& bytes = pictures[index]->bytes;
    const auto* const data = reinterpret_cast<const uint8_t*>(bytes.data());
    const absl::StatusOr<VideoPicture> decoded =
        decoder.decode({data, bytes.size()}, sizeOf(layout.video().picture_size()));
    if (!decoded.ok()) return asLoss(index, decoded.status());
    writeViews(*decoded, layout, index, picture);
  }
  return picture;
}

AtlasPicture unstack(const AtlasPicture& stacked, const v1::AtlasLayout& layout) {
  const v1::VideoStack& stack = layout.video();
  AtlasPicture picture = emptyAtlas(layout, stacked.channels);
  const size_t row_bytes = size_t{layout.tile_size().width()} * stacked.channels;
  for (uint32_t view = 0; view < layout.view_count(); ++view) {
    CellPlace cell = placeOfCell(stack, view);
    cell.y_px += view % stack.picture_count() * stack.picture_size().height();
    const size_t from = firstSample(stacked, {.left_px = cell.x_px, .top_px = cell.y_px});
    const size_t to = firstSample(picture, placeOfView(layout, view));
    for (size_t row = 0; row < layout.tile_size().height(); ++row) {
      std::copy_n(&stacked.samples[from + row * stacked.width_px * stacked.channels], row_bytes,
                  &picture.samples[to + row * picture.width_px * picture.channels]);
    }
  }
  return picture;
}

}  // namespace viewloom
