// SPDX-License-Identifier: Apache-2.0
// Real files: a stereo EXR with cropped windows and a light field with a disparity map.
#include <Imath/half.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "files/exr_image.h"
#include "files/netpbm_image.h"
#include "files/png_image.h"

namespace viewloom::files::shared_data_test {
namespace {

class SharedData : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(folder_)) GTEST_SKIP() << folder_ << " is not there";
  }

  std::filesystem::path folder_ = VIEWLOOM_SHARED_DATA;
};

class Beachball : public SharedData {
 protected:
  static float depthAt(const PlaneImage& image, uint32_t x, uint32_t y) {
    Imath::half value;
    std::memcpy(static_cast<void*>(&value), &image.bytes[2 * (size_t{y} * image.width_px + x)], 2);
    return value;
  }
};

TEST_F(Beachball, hasDepthInsideItsDataWindowAndNothingOutside) {
  const auto file = folder_ / "beachball-stereo/singlepart.0001.exr";
  const auto channels = exrChannelsOfView(file, "right");
  ASSERT_TRUE(channels.ok()) << channels.status();
  const auto depth = readExrDepth(file, channels->depth);
  ASSERT_TRUE(depth.ok()) << depth.status();
  ASSERT_EQ(depth->width_px, 2048U);
  ASSERT_EQ(depth->height_px, 1556U);
  float near = INFINITY, far = 0;
  for (uint32_t y = 0; y < depth->height_px; ++y) {
    for (uint32_t x = 0; x < depth->width_px; ++x) {
      const float z = depthAt(*depth, x, y);
      if (x < 654 || x > 1564 || y < 245 || y > 1120) {
        ASSERT_EQ(z, 0.0F);
      } else if (z != 0) {
        near = std::min(near, z);
        far = std::max(far, z);
      }
    }
  }
  EXPECT_NEAR(near, 9.0F, 0.01F);
  EXPECT_NEAR(far, 10.92F, 0.01F);
}

TEST_F(Beachball, relatesItsTwoEyesByTheDerivedCamera) {
  const auto file = folder_ / "beachball-stereo/singlepart.0001.exr";
  const auto right = readExrDepth(file, {});
  const std::vector<std::string> left_channel{"left.Z"};
  const auto left = readExrDepth(file, left_channel);
  ASSERT_TRUE(right.ok() && left.ok());
  // x_left = x_right + focal * baseline / Z, and Z is the same in both eyes. The middle of the
  // ball.
  const float z = depthAt(*right, 1100, 700);
  const auto x_left = static_cast<uint32_t>(std::lround(1100 + 2048 * 0.162754 / z));
  EXPECT_NEAR(depthAt(*left, x_left, 700), z, 0.02F);
}

TEST_F(Beachball, isCroppedWhereItsDataWindowLeavesTheDisplay) {
  const auto file = folder_ / "beachball-stereo/singlepart.0008.exr";
  const auto color = readExrColor(file, {});
  ASSERT_TRUE(color.ok()) << color.status();
  EXPECT_EQ(color->width_px, 2048U);
  EXPECT_EQ(color->height_px, 1556U);
  EXPECT_TRUE(color->has_alpha);
}

TEST_F(SharedData, antinousHasTheDocumentedDisparities) {
  const auto disparity = readPfmDepth(folder_ / "hci-antinous/gt_disp_lowres.pfm");
  ASSERT_TRUE(disparity.ok()) << disparity.status();
  ASSERT_EQ(disparity->width_px, 512U);
  std::vector<float> samples(disparity->bytes.size() / 4);
  std::memcpy(samples.data(), disparity->bytes.data(), disparity->bytes.size());
  const auto [low, high] = std::minmax_element(samples.begin(), samples.end());
  EXPECT_NEAR(*low, -3.131F, 0.001F);
  EXPECT_NEAR(*high, 2.689F, 0.001F);
}

TEST_F(SharedData, antinousMovesAsItsDisparitySays) {
  const auto disparity = readPfmDepth(folder_ / "hci-antinous/gt_disp_lowres.pfm");
  const auto centre = readPngColor(folder_ / "hci-antinous/input_Cam040.png", false);
  const auto right = readPngColor(folder_ / "hci-antinous/input_Cam041.png", false);
  ASSERT_TRUE(disparity.ok() && centre.ok() && right.ok());
  ASSERT_EQ(centre->encoding, v1::PLANE_ENCODING_RGB8);
  // x_t = x - d per view to the right: read the right way up, that is closer than any mirror image.
  const auto errorWith = [&](bool upside_down, double sign) {
    double sum = 0;
    for (size_t y = 0; y < 512; ++y) {
      for (size_t x = 8; x < 504; ++x) {
        float d = 0;
        std::memcpy(&d, &disparity->bytes[4 * ((upside_down ? 511 - y : y) * 512 + x)], 4);
        const auto moved = static_cast<size_t>(std::lround(static_cast<double>(x) + sign * d));
        sum += std::abs(centre->bytes[3 * (y * 512 + x)] - right->bytes[3 * (y * 512 + moved)]);
      }
    }
    return sum;
  };
  EXPECT_LT(errorWith(false, -1), 0.8 * errorWith(true, -1));
  EXPECT_LT(errorWith(false, -1), 0.8 * errorWith(false, 1));
}

}  // namespace
}  // namespace viewloom::files::shared_data_test
