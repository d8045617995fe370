// SPDX-License-Identifier: Apache-2.0
#include "base/check.h"
#include "fuzz/seeds.h"
#include "unit/video/sample_picture.h"
#include "video/openh264_encoder.h"

namespace viewloom {

// Stacks of three pictures, coded as a whole and in slices.
SeedBytes videoSeeds() {
  constexpr SizePx kSize_px = {64, 128};
  SeedBytes seeds;
  for (const uint32_t thread_count : {1U, 2U}) {
    auto encoder =
        OpenH264Encoder::make({.size_px = kSize_px, .qp = 30, .thread_count = thread_count});
    VIEWLOOM_CHECK(encoder.ok());
    SeedWriter script;
    script.bytes({uint8_t(kSize_px.width / 2 - 1), uint8_t(kSize_px.height / 2 - 1)});
    for (int i = 0; i < 3; ++i) {
      std::vector<uint8_t> unit;
      const absl::Status status =
          (*encoder)->encode(test::SamplePicture::texture(kSize_px, i).video(),
                             i == 0 ? Reference::kNone : Reference::kPictureBefore, unit);
      VIEWLOOM_CHECK(status.ok());
      script.counted(std::string(unit.begin(), unit.end()));
    }
    seeds.push_back(script.done());
  }
  return seeds;
}

}  // namespace viewloom
