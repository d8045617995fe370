// SPDX-License-Identifier: Apache-2.0
#include "frame/validate_plane.h"

#include <gtest/gtest.h>

#include <string>

#include "frame/limits.h"

namespace viewloom::validate_plane_test {
namespace {

PlaneFormat videoOf(SizePx size_px) {
  return {.kind = PlaneKind::kColor,
          .encoding = PlaneEncoding::kH264,
          .size_px = size_px,
          .wire_bytes = 100};
}

// The field that is refused, or "".
std::string refusedField(const PlaneFormat& plane, bool is_cube_map = false) {
  return fieldOf(validatePlane(plane, PlaneKind::kColor, is_cube_map, 8192));
}

TEST(ValidatePlane, takesVideoFromAMacroblockToTheLargestPlane) {
  for (const SizePx size_px : {SizePx{16, 16}, SizePx{17, 8191}, SizePx{8192, 8192}}) {
    PlaneFormat video = videoOf(size_px);
    EXPECT_EQ(refusedField(video), "");
    video.wire_bytes = h264BytesMax(size_px);
    EXPECT_EQ(refusedField(video), "");
  }
  EXPECT_EQ(refusedField(videoOf({8192, 6 * 8192}), true), "");
}

TEST(ValidatePlane, namesTheFieldOfVideoThatDoesNotFit) {
  EXPECT_EQ(refusedField(videoOf({640, 15})), "size");
  EXPECT_EQ(refusedField(videoOf({8193, 64})), "size");
  PlaneFormat video = videoOf({64, 64});
  video.stride_bytes = 256;
  EXPECT_EQ(refusedField(video), "stride_bytes");
  video = videoOf({64, 64});
  video.compression = PlaneCompression::kZstd;
  EXPECT_EQ(refusedField(video), "compression");
  for (const uint64_t bytes : {uint64_t{0}, h264BytesMax({64, 64}) + 1, uint64_t{1} << 63}) {
    video = videoOf({64, 64});
    video.wire_bytes = bytes;
    EXPECT_EQ(refusedField(video), "bytes_count") << bytes;
  }
  video = videoOf({64, 64});
  video.kind = PlaneKind::kDepth;
  EXPECT_EQ(fieldOf(validatePlane(video, PlaneKind::kDepth, false, 8192)), "encoding");
}

}  // namespace
}  // namespace viewloom::validate_plane_test
