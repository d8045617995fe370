// SPDX-License-Identifier: Apache-2.0
#include "base/check.h"
#include "fuzz/seeds.h"
#include "support/video/sample_picture.h"
#include "video/openh264_encoder.h"

namespace viewloom {
namespace {

// Three pictures that refer to each other.
std::vector<uint8_t> codedStack(const VideoFormat& format) {
  auto encoder = OpenH264Encoder::make(format);
  VIEWLOOM_CHECK(encoder.ok());
  SeedWriter script;
  script.bytes({uint8_t(format.size_px.width / 2 - 1), uint8_t(format.size_px.height / 2 - 1)});
  for (int i = 0; i < 3; ++i) {
    std::vector<uint8_t> unit;
    const absl::Status status =
        (*encoder)->encode(test::SamplePicture::texture(format.size_px, i).video(),
                           i == 0 ? Reference::kNone : Reference::kPictureBefore, unit);
    VIEWLOOM_CHECK(status.ok());
    script.counted(std::string(unit.begin(), unit.end()));
  }
  return script.done();
}

}  // namespace

// The library cuts no slices of less than 48 macroblocks.
SeedBytes videoSeeds() {
  return {codedStack({.size_px = {48, 32}, .qp = 30}),
          codedStack({.size_px = {160, 160}, .qp = 40, .thread_count = 2})};
}

}  // namespace viewloom
