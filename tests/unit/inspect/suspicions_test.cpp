// SPDX-License-Identifier: Apache-2.0
#include "inspect/suspicions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "unit/inspect/depth_planes.h"
#include "unit/inspect/found_kinds.h"

namespace viewloom::inspect::suspicions_test {
namespace {

using test::depthPlane;
using test::DepthPlane;
using test::kindsOf;
using test::suspicionsOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr uint32_t kWidth = 160, kHeight = 120;

// A floor that runs to a wall, and a ball before it: metres.
float roomDepth(uint32_t x, uint32_t y) {
  const float floor_m = 1.3F * kHeight / (2.0F * float(y) - kHeight + 1);
  const float wall_m = y * 2 <= kHeight ? 6 : std::min(6.0F, floor_m);
  const float dx = (float(x) - 80) / 30, dy = (float(y) - 60) / 30;
  const float inside = 1 - dx * dx - dy * dy;
  // The wall leans, so that no depth comes often.
  return inside > 0 ? 2.5F - 0.5F * std::sqrt(inside) : wall_m + 0.002F * float(x);
}

DepthPlane room(const std::function<float(float depth_m)>& stored) {
  return depthPlane<float>(kWidth, kHeight, v1::DEPTH_MEANING_PLANAR,
                           [&](uint32_t x, uint32_t y) { return stored(roomDepth(x, y)); });
}

DepthPlane codes(double codes_per_m, double noise_codes = 0) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, noise_codes > 0 ? noise_codes : 1);
  return depthPlane<uint16_t>(
      kWidth, kHeight, v1::DEPTH_MEANING_PLANAR, [&](uint32_t x, uint32_t y) {
        const double error = noise_codes > 0 ? noise(random) : 0;
        return static_cast<uint16_t>(std::lround(codes_per_m * double{roomDepth(x, y)} + error));
      });
}

TEST(Suspicions, haveNothingAgainstARoomInMetres) {
  EXPECT_THAT(kindsOf(room([](float depth_m) { return depth_m; })), IsEmpty());
}

TEST(Suspicions, seeNearAndFarSwapped) {
  EXPECT_THAT(kindsOf(room([](float depth_m) { return 8 - depth_m; })), ElementsAre("inside-out"));
  EXPECT_THAT(kindsOf(room([](float depth_m) { return 1 / depth_m; })), Contains("inside-out"));
}

TEST(Suspicions, seeASkyBeforeEverything) {
  // Reversed window depth read as if it were not: the cleared sky, 0, lies at the near plane.
  DepthPlane made =
      depthPlane<float>(kWidth, kHeight, v1::DEPTH_MEANING_WINDOW,
                        [](uint32_t x, uint32_t y) { return y < 50 ? 0 : 0.1F / roomDepth(x, y); });
  made.plane.mutable_depth()->set_near_z_m(0.1);
  made.plane.mutable_depth()->set_far_z_m(1000);
  EXPECT_THAT(kindsOf(made), Contains("inside-out"));
  made.plane.mutable_depth()->set_near_z_m(1000);
  made.plane.mutable_depth()->set_far_z_m(0.1);
  EXPECT_THAT(kindsOf(made), Not(Contains("inside-out")));
}

TEST(Suspicions, judgeNoTopAndNoFloorOfACubeMap) {
  const DepthPlane made = room([](float depth_m) { return 8 - depth_m; });
  v1::Camera camera;
  const auto samples = readDepthSamples(made.plane, made.bytes, camera);
  ASSERT_TRUE(samples.ok()) << samples.status();
  const DepthMeasures measures = measureDepth(*samples);
  EXPECT_THAT(suspectDepth({made.plane, 0, *samples, measures, true}), IsEmpty());
}

TEST(Suspicions, seeFlatDepth) {
  EXPECT_THAT(kindsOf(room([](float depth_m) { return 100 + 0.01F * depth_m; })),
              ElementsAre("flat"));
}

TEST(Suspicions, seeClippedDepth) {
  EXPECT_THAT(kindsOf(room([](float depth_m) { return 40 * std::min(depth_m, 4.0F); })),
              Contains("clipped"))
      << "a far plane";
  EXPECT_THAT(kindsOf(room([](float depth_m) { return std::min(depth_m, 4.0F); })),
              Not(Contains("clipped")))
      << "a wall square to the view";
  DepthPlane made = codes(20000);  // 16 bits end at 3.3 m
  for (size_t i = 0; i < made.bytes.size(); i += 2) {
    const auto index = static_cast<uint32_t>(i / 2);
    const double depth_m = double{roomDepth(index % kWidth, index / kWidth)};
    const auto code = static_cast<uint16_t>(std::min(65535.0, 20000 * depth_m));
    std::memcpy(&made.bytes[i], &code, 2);
  }
  made.plane.mutable_depth()->set_scale(1 / 20000.0);
  const auto found = suspicionsOf(made, 65535);
  ASSERT_FALSE(found.empty());
  EXPECT_THAT(found, Contains(::testing::Field(&Suspicion::sentence,
                                               HasSubstr("have the largest value, 65535"))));
}

TEST(Suspicions, seeCoarseCodes) {
  DepthPlane coarse = depthPlane<uint16_t>(
      kWidth, kHeight, v1::DEPTH_MEANING_DISPARITY, [](uint32_t x, uint32_t y) {
        return static_cast<uint16_t>(std::lround(255 / double{roomDepth(x, y)}));
      });
  coarse.plane.mutable_depth()->set_scale(1 / 255.0);
  EXPECT_THAT(kindsOf(coarse, 255), Contains("quantised"));
  DepthPlane fine = depthPlane<uint16_t>(
      kWidth, kHeight, v1::DEPTH_MEANING_DISPARITY, [](uint32_t x, uint32_t y) {
        return static_cast<uint16_t>(std::lround(65535 / double{roomDepth(x, y)}));
      });
  fine.plane.mutable_depth()->set_scale(1 / 65535.0);
  EXPECT_THAT(kindsOf(fine, 65535), Not(Contains("quantised")));
}

// A board before a wall, both exact planes, in metres or in steps of 1/Z: all that differs from
// px to px lies at the board's rim.
struct Boards {
  float slope = 0;        // of 1/Z along x, 1/m/px
  float steps_per_m = 0;  // of 1/Z; 0: floats
};

DepthPlane boards(const Boards& kind) {
  const auto invZ = [kind](uint32_t x, uint32_t y) {
    const bool is_board = x >= 50 && x < 110 && y >= 30 && y < 90;
    return is_board ? 0.5F - kind.slope * float(x) / 2 : 0.2F + kind.slope * float(x);
  };
  if (kind.steps_per_m == 0) {
    return depthPlane<float>(kWidth, kHeight, v1::DEPTH_MEANING_PLANAR,
                             [&](uint32_t x, uint32_t y) { return 1 / invZ(x, y); });
  }
  DepthPlane made = depthPlane<uint16_t>(
      kWidth, kHeight, v1::DEPTH_MEANING_DISPARITY, [&](uint32_t x, uint32_t y) {
        return static_cast<uint16_t>(std::lround(kind.steps_per_m * invZ(x, y)));
      });
  made.plane.mutable_depth()->set_scale(1 / double{kind.steps_per_m});
  return made;
}

TEST(Suspicions, haveNothingAgainstExactPlanes) {
  EXPECT_THAT(kindsOf(boards({})), Not(Contains("quantised"))) << "two distances";
  EXPECT_THAT(kindsOf(boards({.slope = 0.0005F})), Not(Contains("quantised")));
  EXPECT_THAT(kindsOf(boards({.slope = -0.0003F})), Not(Contains("quantised")));
}

// 8 bits over 0 .. 1 1/m, of which the board has 128.
TEST(Suspicions, seeSlopesRoundedToEightBits) {
  const DepthPlane coarse = boards({.slope = 0.0005F, .steps_per_m = 255});
  EXPECT_THAT(kindsOf(coarse, 255), Contains("quantised"));
  EXPECT_THAT(kindsOf(boards({.slope = 0.0005F, .steps_per_m = 65535}), 65535),
              Not(Contains("quantised")));
}

TEST(Suspicions, seeNoise) {
  DepthPlane made = codes(1000, 200);  // 20 cm
  made.plane.mutable_depth()->set_scale(0.001);
  EXPECT_THAT(kindsOf(made, 65535), Contains("noisy"));
}

TEST(Suspicions, seeMillimetresAndCentimetresReadAsMetres) {
  const auto millimetres = suspicionsOf(codes(1000), 65535);
  ASSERT_FALSE(millimetres.empty());
  EXPECT_EQ(millimetres[0].kind, "scale");
  EXPECT_THAT(kindsOf(room([](float depth_m) { return 100 * depth_m; })), ElementsAre("scale"));
  EXPECT_THAT(kindsOf(room([](float depth_m) { return 0.001F * depth_m; })), ElementsAre("scale"));
}

TEST(Suspicions, seeTheNothingOfRenderersUnlessItIsNamed) {
  DepthPlane made = room([](float depth_m) { return depth_m > 5 ? 1e10F : depth_m; });
  EXPECT_THAT(kindsOf(made), Contains("nothing"));
  made.plane.mutable_depth()->set_invalid_value(1e10);
  made.plane.mutable_depth()->set_invalid_is_far(true);
  EXPECT_THAT(kindsOf(made), IsEmpty());
}

TEST(Suspicions, nameTheNumberThatWasSeen) {
  const auto found =
      suspicionsOf(room([](float depth_m) { return depth_m > 5 ? 1e30F : depth_m; }));
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].kind, "nothing");
  EXPECT_THAT(found[0].sentence, HasSubstr("1e+30"));
}

TEST(Suspicions, seeWhatIsInsideOutWithoutFloorOrSky) {
  // Two boards before a wall, in 1/m read as metres.
  const auto stored = [](uint32_t x, uint32_t y) {
    const bool is_left = x >= 20 && x < 60 && y >= 30 && y < 90;
    const bool is_right = x >= 100 && x < 140 && y >= 20 && y < 70;
    return is_left ? 0.7F : is_right ? 0.4F : 0.25F + 0.0001F * float(x);
  };
  EXPECT_THAT(kindsOf(depthPlane<float>(kWidth, kHeight, v1::DEPTH_MEANING_PLANAR, stored)),
              Contains("inside-out"));
  EXPECT_THAT(kindsOf(depthPlane<float>(kWidth, kHeight, v1::DEPTH_MEANING_DISPARITY, stored)),
              IsEmpty());
}

TEST(Suspicions, seeZerosScatteredOverInverseDepth) {
  std::mt19937 random(9);
  std::bernoulli_distribution is_measured(0.1);
  const auto sparse = [&](uint32_t x, uint32_t y) {
    return is_measured(random) ? 1 / roomDepth(x, y) : 0;
  };
  EXPECT_THAT(kindsOf(depthPlane<float>(kWidth, kHeight, v1::DEPTH_MEANING_DISPARITY, sparse)),
              Contains("scattered"));
  const auto sky = [](uint32_t x, uint32_t y) { return y < 40 ? 0 : 1 / roomDepth(x, y); };
  EXPECT_THAT(kindsOf(depthPlane<float>(kWidth, kHeight, v1::DEPTH_MEANING_DISPARITY, sky)),
              IsEmpty());
}

TEST(Suspicions, seeFewerBitsThanTheFileHasRoomFor) {
  const auto normalised = [](double last) {
    return depthPlane<uint16_t>(
        kWidth, kHeight, v1::DEPTH_MEANING_DISPARITY, [last](uint32_t x, uint32_t y) {
          return uint16_t(x == 80 && y == 60 ? last : std::round(last / double{roomDepth(x, y)}));
        });
  };
  for (const double last : {1023.0, 4095.0, 16383.0, 32767.0, 32768.0, 32773.0}) {
    EXPECT_THAT(kindsOf(normalised(last), 65535), Contains("bits")) << last;
  }
  EXPECT_THAT(kindsOf(normalised(65535), 65535), Not(Contains("bits")));
  EXPECT_THAT(kindsOf(normalised(5000), 65535), Not(Contains("bits")));
  EXPECT_THAT(kindsOf(normalised(255), 255), Not(Contains("bits"))) << "a file of 8 bits";
  const DepthPlane stretched = depthPlane<uint16_t>(
      kWidth, kHeight, v1::DEPTH_MEANING_DISPARITY, [](uint32_t x, uint32_t y) {
        return uint16_t(257 * std::lround(255 / double{roomDepth(x, y)}));
      });
  EXPECT_THAT(kindsOf(stretched, 65535), Contains("bits"));
}

TEST(Suspicions, seeWhatIsNoSurface) {
  EXPECT_THAT(kindsOf(room([](float) { return 0.0F; })), ElementsAre("empty"));
  EXPECT_THAT(kindsOf(room([](float depth_m) { return depth_m > 2.6F ? 0 : depth_m; })),
              Contains("empty"));
  EXPECT_THAT(kindsOf(room([](float depth_m) { return depth_m < 2.6F ? -1 : depth_m; })),
              Contains("bad"));
}

TEST(Suspicions, seeColourOfAnotherShape) {
  v1::SizePx color, depth;
  color.set_width(1920);
  color.set_height(1080);
  depth.set_width(640);
  depth.set_height(480);
  EXPECT_EQ(suspectShapes(color, depth).front().kind, "shape");
  depth.set_height(360);
  EXPECT_THAT(suspectShapes(color, depth), IsEmpty());
}

}  // namespace
}  // namespace viewloom::inspect::suspicions_test
