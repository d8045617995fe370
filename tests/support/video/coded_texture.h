// SPDX-License-Identifier: Apache-2.0
// Access units of a moving texture, for tests of encoders and files.
#pragma once

#include <vector>

#include <gtest/gtest.h>

#include "support/video/sample_picture.h"
#include "video/annex_b.h"
#include "video/video_encoder.h"

namespace viewloom::test {

using AccessUnit = std::vector<uint8_t>;

// The texture moves by 2 px from one picture to the next. Every `sync_interval`th picture refers to
// no other.
inline std::vector<AccessUnit> codedTexture(VideoEncoder& encoder, int count, int sync_interval) {
  std::vector<AccessUnit> units;
  for (int i = 0; i < count; ++i) {
    const SamplePicture picture = SamplePicture::texture(encoder.format().size_px, 2 * i);
    const Reference reference =
        i % sync_interval == 0 ? Reference::kNone : Reference::kPictureBefore;
    const absl::Status status = encoder.encode(picture.video(), reference, units.emplace_back());
    EXPECT_TRUE(status.ok()) << status;
  }
  return units;
}

inline std::vector<NalType> typesOf(const AccessUnit& access_unit) {
  std::vector<NalType> types;
  for (const NalUnit& unit : nalUnits(access_unit)) types.push_back(unit.type());
  return types;
}

}  // namespace viewloom::test
