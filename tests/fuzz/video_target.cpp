// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "base/check.h"
#include "fuzz/script.h"
#include "fuzz/targets.h"
#include "video/h264_parameters.h"
#include "video/openh264_decoder.h"

namespace viewloom {
namespace {

// Reads every sample, so that sanitizers see each of them.
uint64_t sumOf(const VideoPicture& picture) {
  uint64_t sum = 0;
  for (size_t y = 0; y < picture.size_px.height; ++y) {
    for (size_t x = 0; x < picture.size_px.width; ++x) {
      sum += picture.y[y * picture.y_stride_bytes + x];
      const size_t chroma = y / 2 * picture.chroma_stride_bytes + x / 2;
      sum += picture.cb[chroma] + picture.cr[chroma];
    }
  }
  return sum;
}

}  // namespace

bool fuzzVideo(FuzzBytes bytes) {
  Script script(bytes);
  const SizePx size_px = {2 * script.take() + 2, 2 * script.take() + 2};
  auto decoder = OpenH264Decoder::make();
  VIEWLOOM_CHECK(decoder.ok());
  bool are_all_decoded = !script.atEnd();
  while (!script.atEnd()) {
    const size_t unit_bytes = script.take(2);
    const FuzzBytes unit = script.takeBytes(unit_bytes);
    const absl::StatusOr<H264Parameters> parameters = h264ParametersOf(unit);
    const absl::StatusOr<VideoPicture> picture = (*decoder)->decode(unit, size_px);
    are_all_decoded &= picture.ok();
    if (!picture.ok()) continue;
    VIEWLOOM_CHECK(picture->size_px == size_px);
    VIEWLOOM_CHECK(!parameters.ok() || parameters->size_px == size_px);
    VIEWLOOM_CHECK(sumOf(*picture) <= 3 * 255 * size_px.area());
  }
  return are_all_decoded;
}

}  // namespace viewloom
