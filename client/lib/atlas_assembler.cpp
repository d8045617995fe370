// SPDX-License-Identifier: Apache-2.0
#include "lib/atlas_assembler.h"

#include <algorithm>
#include <utility>

#include "base/str_cat.h"
#include "lib/stacked_atlas.h"

namespace viewloom {

namespace {

constexpr uint32_t kSideMax_px = 16384;  // as display.proto

// A layout of which views can be cut. Sizes in 64 bits: the products of foreign ones fit.
absl::Status checkLayout(const v1::AtlasLayout& layout) {
  const uint64_t width = layout.size().width();
  const uint64_t height = layout.size().height();
  if (std::min(width, height) == 0 || std::max(width, height) > kSideMax_px) {
    return absl::DataLossError(strCat("the layout has an atlas of ", width, "x", height,
                                      " px; accepted is 1..", kSideMax_px, " px a side"));
  }
  const bool has_room =
      uint64_t{layout.columns()} * layout.tile_size().width() <= width &&
      uint64_t{layout.rows()} * layout.tile_size().height() + layout.padding_top_px() <= height &&
      layout.view_count() <= uint64_t{layout.columns()} * layout.rows();
  if (!has_room) return absl::DataLossError("the layout has an atlas without room for its views");
  const uint32_t images = std::max(layout.image_count(), 1U);
  if (height % images != 0) {
    return absl::DataLossError(strCat("the layout has ", images, " images in ", height,
                                      " rows; accepted are images of equal height"));
  }
  return layout.has_video() ? checkStack(layout) : absl::OkStatus();
}

// Older servers, and recordings of them, say it before the bands.
void takeOutcomeOf(v1::AtlasHeader& header, v1::AtlasEnd& end) {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
  if (!end.has_times() && header.has_times()) end.mutable_times()->Swap(header.mutable_times());
  if (!end.has_coverage() && header.has_coverage()) {
    end.mutable_coverage()->Swap(header.mutable_coverage());
  }
  if (!end.has_reflections() && header.has_reflections()) {
    end.mutable_reflections()->Swap(header.mutable_reflections());
  }
  header.clear_times();
  header.clear_coverage();
  header.clear_reflections();
#pragma GCC diagnostic pop
}

}  // namespace

AtlasAssembler::AtlasAssembler(uint64_t bytes_max) : bytes_max_(bytes_max) {}

void AtlasAssembler::restart() {
  discard();
  last_sequence_ = 0;
}

void AtlasAssembler::discard() {
  counts_.discarded += open_.has_value();
  open_.reset();
  band_is_open_ = false;
  bytes_ = 0;
}

absl::StatusOr<std::optional<Atlas>> AtlasAssembler::add(v1::StreamAtlasesResponse message) {
  if (message.has_layout()) {
    VIEWLOOM_RETURN_IF_ERROR(checkLayout(message.layout()));
    discard();
    last_sequence_ = 0;
    layout_ = std::make_shared<const v1::AtlasLayout>(std::move(*message.mutable_layout()));
  } else if (message.has_header()) {
    if (layout_ == nullptr) return absl::DataLossError("an atlas came before any layout");
    begin(std::move(*message.mutable_header()));
  } else if (message.has_band()) {
    VIEWLOOM_RETURN_IF_ERROR(addBand(std::move(*message.mutable_band())));
  } else if (message.has_end()) {
    return end(std::move(*message.mutable_end()));
  } else if (message.has_abandoned()) {
    discard();
  } else if (message.has_skipped()) {
    counts_.skipped += message.skipped().count();
  }
  return std::optional<Atlas>();
}

void AtlasAssembler::begin(v1::AtlasHeader header) {
  discard();
  // The first atlas of a call or layout may have any number: others may have watched before.
  if (last_sequence_ != 0 && header.sequence() > last_sequence_ + 1) {
    counts_.gaps += header.sequence() - last_sequence_ - 1;
  }
  last_sequence_ = header.sequence();
  open_ = Atlas{.layout = layout_, .header = std::move(header), .end = {}, .bands = {}};
}

absl::Status AtlasAssembler::addBand(v1::Band band) {
  if (!open_ || band.sequence() != open_->header.sequence()) {
    return absl::DataLossError(strCat("a band of atlas ", band.sequence(), " came outside it"));
  }
  bytes_ += band.data().size();
  if (bytes_ > bytes_max_) {
    return absl::ResourceExhaustedError(
        strCat("atlas ", band.sequence(), " has more than ", bytes_max_, " bytes"));
  }
  if (!band_is_open_) {
    if (band.row_count() == 0 || open_->bands.size() == open_->header.band_count()) {
      return absl::DataLossError(strCat("atlas ", band.sequence(), " has a band without rows, or ",
                                        "more bands than the ", open_->header.band_count(),
                                        " that its header says"));
    }
    open_->bands.push_back({.image_index = band.image_index(),
                            .plane = band.plane(),
                            .first_row = band.first_row(),
                            .row_count = band.row_count(),
                            .encoding = band.encoding(),
                            .bytes = {}});
  }
  AtlasBand& to = open_->bands.back();
  if (band.offset_bytes() != to.bytes.size() || band.first_row() != to.first_row ||
      band.plane() != to.plane || band.image_index() != to.image_index) {
    return absl::DataLossError(strCat("a piece of atlas ", band.sequence(), ", row ",
                                      band.first_row(), ", came out of order"));
  }
  if (to.bytes.empty()) {
    to.bytes = std::move(*band.mutable_data());
  } else {
    to.bytes += band.data();
  }
  if (to.bytes.empty()) {
    return absl::DataLossError(strCat("a band of atlas ", band.sequence(), " has no bytes"));
  }
  band_is_open_ = !band.last_piece();
  return absl::OkStatus();
}

absl::StatusOr<std::optional<Atlas>> AtlasAssembler::end(v1::AtlasEnd end) {
  const uint64_t sequence = end.sequence();
  if (!open_ || sequence != open_->header.sequence() || band_is_open_ ||
      open_->bands.size() != open_->header.band_count()) {
    return absl::DataLossError(strCat("atlas ", sequence, " ended before it was whole"));
  }
  std::optional<Atlas> whole = std::exchange(open_, std::nullopt);
  whole->end = std::move(end);
  takeOutcomeOf(whole->header, whole->end);
  bytes_ = 0;
  ++counts_.whole;
  return whole;
}

}  // namespace viewloom
