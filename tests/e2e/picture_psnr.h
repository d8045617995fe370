// SPDX-License-Identifier: Apache-2.0
// The difference of two decoded atlases.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "lib/atlas.h"
#include "scoring/psnr.h"

namespace viewloom::test {

// PSNR in dB. Pictures of two sizes fail the test.
inline double psnrDb(const AtlasPicture& a, const AtlasPicture& b) {
  EXPECT_EQ(a.samples.size(), b.samples.size());
  Psnr psnr;
  for (size_t i = 0; i < std::min(a.samples.size(), b.samples.size()); ++i) {
    psnr.add((double(a.samples[i]) - double(b.samples[i])) / 255);
  }
  return psnr.db();
}

// Luma of BT.601, of 1.
inline double lumaAt(const AtlasPicture& picture, size_t px) {
  const auto* const rgb = &picture.samples[3 * px];
  return (0.299 * double(rgb[0]) + 0.587 * double(rgb[1]) + 0.114 * double(rgb[2])) / 255;
}

// The same of what video keeps at full size: in small views with edges of full colour, 4:2:0 alone
// takes colour to 30 dB.
inline double lumaPsnrDb(const AtlasPicture& a, const AtlasPicture& b) {
  EXPECT_EQ(a.samples.size(), b.samples.size());
  Psnr psnr;
  for (size_t px = 0; px < std::min(a.samples.size(), b.samples.size()) / 3; ++px) {
    psnr.add(lumaAt(a, px) - lumaAt(b, px));
  }
  return psnr.db();
}

// The finest quantisation has errors of a code or two, and clipped colour some more.
inline constexpr double kFineLumaDb = 36;

}  // namespace viewloom::test
