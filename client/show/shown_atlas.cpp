// SPDX-License-Identifier: Apache-2.0
#include "show/shown_atlas.h"

#include <cmath>
#include <utility>

#include "base/str_cat.h"

namespace viewloom::show {
namespace {

bool isOnePicture(const v1::AtlasLayout& layout) {
  return layout.columns() <= 1 && layout.rows() <= 1;
}

PixelArea wholeOf(SizePx size_px) {
  return {.width_px = static_cast<double>(size_px.width),
          .height_px = static_cast<double>(size_px.height)};
}

// Whether every view's tile lies within the atlas.
bool holdsItsTiles(const v1::AtlasLayout& layout) {
  const uint64_t width_px = uint64_t{layout.columns()} * layout.tile_size().width();
  const uint64_t height_px =
      uint64_t{layout.rows()} * layout.tile_size().height() + layout.padding_top_px();
  return width_px > 0 && width_px <= layout.size().width() && height_px > 0 &&
         height_px <= layout.size().height() && layout.view_count() > 0 &&
         layout.view_count() <= uint64_t{layout.columns()} * layout.rows();
}

PixelArea areaOfView(const v1::AtlasLayout& layout, uint32_t view) {
  const TilePlace place = placeOfView(layout, view);
  return {.left_px = static_cast<double>(place.left_px),
          .top_px = static_cast<double>(place.top_px),
          .width_px = static_cast<double>(layout.tile_size().width()),
          .height_px = static_cast<double>(layout.tile_size().height())};
}

}  // namespace

absl::StatusOr<DecodedAtlas> decodeAtlas(const Atlas& atlas, ColorDecoder& decoder) {
  if (!isOnePicture(*atlas.layout) && !holdsItsTiles(*atlas.layout)) {
    return absl::DataLossError(strCat("the server's layout says ", atlas.layout->view_count(),
                                      " views in ", atlas.layout->columns(), "x",
                                      atlas.layout->rows(), " tiles that its atlas cannot hold"));
  }
  absl::StatusOr<AtlasPicture> picture = decoder.decode(atlas);
  if (!picture.ok()) return picture.status();
  return DecodedAtlas{*std::move(picture), atlas.layout, atlas.header};
}

absl::Status ShownAtlas::replace(const DecodedAtlas& atlas) {
  VIEWLOOM_RETURN_IF_ERROR(texture_.upload({atlas.picture.width_px, atlas.picture.height_px},
                                           atlas.picture.channels, atlas.picture.samples));
  layout_ = atlas.layout;
  header_ = atlas.header;
  return absl::OkStatus();
}

const v1::AtlasLayout& ShownAtlas::layout() const {
  return isThere() ? *layout_ : v1::AtlasLayout::default_instance();
}

void ShownAtlas::draw(const ShowSettings& settings, const std::optional<Calibration>& calibration,
                      SizePx window_px, Painter& painter) const {
  if (!isThere()) return;
  const PixelArea whole = wholeOf(texture_.sizePx());
  if (isOnePicture(*layout_)) {
    // For the panel from its top left px on; anything else as large as it fits.
    const bool is_native = calibration && texture_.sizePx() == calibration->screen_px;
    const double aspect = whole.width_px / whole.height_px;
    painter.place(texture_, whole, is_native ? whole : fitInto(wholeOf(window_px), aspect));
  } else if (settings.mode == ShowMode::kQuilt) {
    painter.place(texture_, whole, fitInto(wholeOf(window_px), whole.width_px / whole.height_px));
  } else if (calibration &&
             (settings.mode == ShowMode::kWeave || settings.mode == ShowMode::kNative)) {
    painter.weave(texture_, *layout_, *calibration, settings.is_blended);
  } else {
    drawViews(settings, window_px, painter);
  }
}

void ShownAtlas::drawViews(const ShowSettings& settings, SizePx window_px, Painter& painter) const {
  const double tile_aspect =
      double{1} * layout_->tile_size().width() / layout_->tile_size().height();
  const double aspect = layout_->aspect() > 0 ? layout_->aspect() : tile_aspect;
  PixelArea area = wholeOf(window_px);
  const uint32_t first = firstView(settings, *layout_);
  if (settings.mode != ShowMode::kPair) {
    painter.place(texture_, areaOfView(*layout_, first), fitInto(area, aspect));
    return;
  }
  area.width_px = std::floor(area.width_px / 2);  // an odd column stays black
  painter.place(texture_, areaOfView(*layout_, first), fitInto(area, aspect));
  area.left_px = area.width_px;
  painter.place(texture_, areaOfView(*layout_, secondView(settings, *layout_)),
                fitInto(area, aspect));
}

}  // namespace viewloom::show
