// SPDX-License-Identifier: Apache-2.0
#include "display/color_form.h"

#include "base/check.h"

namespace viewloom {

ColorForm directForm(const EncodingSpec& encoding) {
  if (encoding.color == BandEncoding::kH264) return ColorForm::kYcbcr420;
  if (encoding.color != BandEncoding::kJpeg) return ColorForm::kRgba;
  return encoding.chroma == Chroma::k420 ? ColorForm::kYcbcr420 : ColorForm::kYcbcr444;
}

YcbcrLayout::YcbcrLayout(SizePx size_px, ColorForm form) {
  VIEWLOOM_CHECK(form != ColorForm::kRgba);
  const uint32_t shared_px = form == ColorForm::kYcbcr420 ? 2 : 1;  // px a chroma sample, each way
  luma_stride = (size_px.width + kPadding_px - 1) / kPadding_px * kPadding_px;
  luma_row_count = size_px.height;
  chroma_stride = luma_stride / shared_px;
  chroma_row_count = (size_px.height + shared_px - 1) / shared_px;
}

}  // namespace viewloom
