// SPDX-License-Identifier: Apache-2.0
#include "sweep/ycbcr_rows.h"

#include "sweep/ycbcr_kernels.h"

namespace viewloom {
namespace {

constexpr uint32_t kBlack = 0;

}  // namespace

void YcbcrRows::begin(const AtlasLayout& layout, ColorForm form, uint32_t first_row,
                      uint32_t row_count, GridRows grid) {
  layout_ = &layout;
  form_ = form;
  first_row_ = first_row;
  end_row_ = first_row + row_count;
  grid_ = grid;
  stride_px_ = YcbcrLayout(layout.size_px, form).luma_stride;
  const size_t count = (size_t{layout.rows} + 1) * 2 * stride_px_;
  rows_.reserve(count);
  std::fill_n(rows_.data(), count, kBlack);
}

bool YcbcrRows::takesRow(uint32_t grid_row, Step step) const {
  if (grid_row < grid_.first || grid_row >= grid_.end) return false;
  const auto isInPiece = [&](uint32_t row) { return first_row_ <= row && row < end_row_; };
  if (form_ == ColorForm::kYcbcr444) return !step.is_crossing && isInPiece(step.tile_row);
  const bool is_upper = atlasRow(grid_row, step) % 2 == 0;
  const bool is_crossing = !is_upper && step.tile_row == 0;
  if (step.is_crossing || is_crossing) return step.is_crossing && is_crossing;
  const uint32_t last_row = layout_->tile_size_px.height - 1;
  if (is_upper && step.tile_row == last_row) return isInPiece(last_row);
  // A pair belongs to the even one of its rows of a tile.
  const uint32_t upper_row = step.tile_row - (is_upper ? 0 : 1);
  return isInPiece(upper_row + upper_row % 2);
}

// A row that crosses lies below one of the tiles above.
uint32_t* YcbcrRows::bufferOf(uint32_t grid_row, Step step) {
  const uint32_t pair = grid_row + (step.is_crossing ? 0 : 1);
  return rows_.data() + (size_t{pair} * 2 + atlasRow(grid_row, step) % 2) * stride_px_;
}

uint32_t* YcbcrRows::rowOf(uint32_t tile, Step step) {
  return bufferOf(tile / layout_->columns, step) +
         size_t{tile % layout_->columns} * layout_->tile_size_px.width;
}

void YcbcrRows::convert(uint32_t grid_row, Step step, uint8_t* planes) {
  const YcbcrLayout at(layout_->size_px, form_);
  const uint32_t y = atlasRow(grid_row, step);
  uint32_t* const row = bufferOf(grid_row, step);
  std::fill(row + layout_->size_px.width, row + stride_px_, row[layout_->size_px.width - 1]);
  uint8_t* const luma = planes + size_t{y} * at.luma_stride;
  const bool is_444 = form_ == ColorForm::kYcbcr444;
  const size_t chroma = size_t{is_444 ? y : y / 2} * at.chroma_stride;
  uint8_t* const cb = planes + at.cbOffset() + chroma;
  uint8_t* const cr = planes + at.crOffset() + chroma;
  if (is_444) return ycbcrRow444(row, stride_px_, luma, cb, cr);
  const bool is_lower = y % 2 == 1;
  if (!is_lower && y + 1 < layout_->size_px.height) return;
  // The last row of an odd height stands for the one below it.
  ycbcrRows420({.upper_rgba = is_lower ? row - stride_px_ : row,
                .lower_rgba = row,
                .upper_luma = is_lower ? luma - at.luma_stride : luma,
                .lower_luma = luma,
                .cb = cb,
                .cr = cr},
               stride_px_);
}

}  // namespace viewloom
