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

}  // namespace viewloom::test
