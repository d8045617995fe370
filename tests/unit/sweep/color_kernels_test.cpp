// SPDX-License-Identifier: Apache-2.0
// Colours of places, on every kind of CPU that this one can be.
#include "sweep/color_kernels.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <vector>

#include "sweep/packed_codes.h"
#include "sweep/surface_row.h"

namespace viewloom::color_kernels_test {
namespace {

constexpr uint32_t kBackground = 0xff102030;
// Whole vectors of any CPU, and a rest.
constexpr uint32_t kWidth_px = 200;

uint32_t packedGrey(uint32_t code) {
  return code * uint32_t(kRedSteps) | code * uint32_t(kGreenSteps) << kGreenShift |
         code * uint32_t(kBlueSteps) << kBlueShift;
}

// Half way between texels of 2 n and 2 n + 2 lies 2 n + 1.
uint32_t greyOf(int32_t place) {
  if (place < 0) return kBackground;
  return 0xff000000 | uint32_t(2 * place / kSubtexelSteps) * 0x010101;
}

TEST(ColorKernels, colorPlacesWhereverTheyLieInMemory) {
  std::vector<uint32_t> texels;
  for (uint32_t n = 0; n <= kWidth_px / 2; ++n) texels.push_back(packedGrey(2 * n));
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    for (size_t ahead = 0; ahead < 3; ++ahead) {
      std::vector<int32_t> places(ahead);
      for (uint32_t p = 0; p < kWidth_px; ++p) {
        places.push_back(p % 7 == 3 ? -1 : int32_t(p) * kSubtexelSteps / 2);
      }
      std::vector<uint32_t> rgba(ahead + kWidth_px);
      colorRow(texels.data(), uint32_t(texels.size()), places.data() + ahead, kWidth_px,
               kBackground, rgba.data() + ahead);
      for (uint32_t p = 0; p < kWidth_px; ++p) {
        ASSERT_EQ(rgba[ahead + p], greyOf(places[ahead + p])) << ahead << ", px " << p;
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace
}  // namespace viewloom::color_kernels_test
