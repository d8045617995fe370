// SPDX-License-Identifier: Apache-2.0
#include "retime/frame_retimer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <vector>

#include "frame/limits.h"
#include "unit/retime/moved_frames.h"

namespace viewloom::test::frame_retimer_test {
namespace {

// Whatever is further apart than that is two things.
constexpr double kTolerance = 0.05;
constexpr float kNear = 0.5F;  // 1/m: what moves
constexpr float kFar = 0.25F;  // 1/m: what stands behind it
// At 1 m/s what is 2 m away goes a px in so many seconds.
constexpr double kPxTime_s = 1 / (kMovedFocal_px * kNear);
// 1/m: shares of samples that lie on px are off by roundings of 1e-7.
constexpr float kInvZError = 1e-6F;

MovingPx wallAt(uint32_t x, uint32_t y, const glm::vec3& motion_mps = {}) {
  return {.inv_z = kFar, .color = colorOfPx(x, y, 10), .motion_mps = motion_mps};
}

bool isPlate(uint32_t x, uint32_t y) {
  return x >= 10 && x < 18 && y >= 8 && y < 16;
}

// A plate that moves to the right before a static wall.
MovingPx plateAt(uint32_t x, uint32_t y) {
  if (!isPlate(x, y)) return wallAt(x, y);
  return {.inv_z = kNear, .color = colorOfPx(x, y, 200), .motion_mps = {1, 0, 0}};
}
MovingPx behindPlateAt(uint32_t x, uint32_t y) {
  return isPlate(x, y) ? wallAt(x, y) : MovingPx{};
}

glm::u8vec3 mixOf(const MovingPx& a, const MovingPx& b, float share_of_a) {
  return {glm::round(glm::mix(glm::vec3(b.color), glm::vec3(a.color), share_of_a))};
}

// Colour at an edge comes from half a pixel further away. Here it changes by up to 10 codes a
// pixel. The rest is rounding, which is smaller.
constexpr int kColorError = 5;

void expectNear(const glm::u8vec3& got, const glm::u8vec3& wanted) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(got[i], wanted[i], kColorError) << "channel " << i;
}

class FrameRetimerTest : public testing::Test {
 protected:
  FramePtr retimed(const FramePtr& frame, double seconds) {
    return FrameRetimer(workers_).retime(frame, seconds);
  }

  WorkerPool workers_{3};
};

TEST_F(FrameRetimerTest, movesWhatMovesByWholePxAndKeepsTheRestToTheByte) {
  constexpr uint32_t kGone_px = 4;
  const FramePtr frame = movingFrame({plateAt, behindPlateAt}, kTolerance);
  const FramePtr later = retimed(frame, kGone_px * kPxTime_s);
  for (uint32_t y = 0; y < kMovedPx.height; ++y) {
    for (uint32_t x = 0; x < kMovedPx.width; ++x) {
      SCOPED_TRACE(testing::Message() << x << ", " << y);
      const bool is_plate = x >= kGone_px && isPlate(x - kGone_px, y);
      const MovingPx front = is_plate ? plateAt(x - kGone_px, y) : wallAt(x, y);
      EXPECT_NEAR(invZAt(*later, 0, x, y), front.inv_z, kInvZError);
      EXPECT_EQ(colorAt(*later, 0, x, y), front.color);
      // The wall that it hides now was seen before, and stays known.
      EXPECT_EQ(invZAt(*later, 1, x, y), is_plate ? kFar : -1);
      if (!is_plate) continue;
      EXPECT_EQ(colorAt(*later, 1, x, y), wallAt(x, y).color);
    }
  }
}

TEST_F(FrameRetimerTest, goesBackInTimeAsWell) {
  const FramePtr earlier =
      retimed(movingFrame({plateAt, behindPlateAt}, kTolerance), -3 * kPxTime_s);
  EXPECT_NEAR(invZAt(*earlier, 0, 7, 12), kNear, kInvZError);
  EXPECT_EQ(colorAt(*earlier, 0, 7, 12), plateAt(10, 12).color);
  EXPECT_EQ(colorAt(*earlier, 0, 15, 12), wallAt(15, 12).color);
}

TEST_F(FrameRetimerTest, fillsWhatNoLayerHoldsFromTheFartherSideOfTheRow) {
  const FramePtr later = retimed(movingFrame({plateAt}, kTolerance), 4 * kPxTime_s);
  for (uint32_t x = 10; x < 14; ++x) {
    EXPECT_EQ(invZAt(*later, 0, x, 12), kFar);
    EXPECT_EQ(colorAt(*later, 0, x, 12), wallAt(9, 12).color) << "of the wall, not of the plate";
  }
}

TEST_F(FrameRetimerTest, leavesHolesThatTheFrameHas) {
  const auto layer = [](uint32_t x, uint32_t y) { return x < 5 ? MovingPx{} : plateAt(x, y); };
  const FramePtr later = retimed(movingFrame({layer}, kTolerance), 2 * kPxTime_s);
  EXPECT_LT(invZAt(*later, 0, 3, 12), 0);
  EXPECT_EQ(invZAt(*later, 0, 5, 12), kFar);
}

TEST_F(FrameRetimerTest, blendsColoursBetweenPx) {
  const FramePtr later =
      retimed(movingFrame({plateAt, behindPlateAt}, kTolerance), 0.5 * kPxTime_s);
  const glm::u8vec3 left = plateAt(12, 12).color, right = plateAt(13, 12).color;
  const glm::u8vec3 between = colorAt(*later, 0, 13, 12);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(between[i], 0.5 * (left[i] + right[i]), 1) << i;
  // Half covered; of two such px one has the plate's depth.
  expectNear(colorAt(*later, 0, 10, 12), mixOf(plateAt(10, 12), wallAt(10, 12), 0.5));
  expectNear(colorAt(*later, 0, 18, 12), mixOf(plateAt(17, 12), wallAt(18, 12), 0.5));
  EXPECT_NEAR(invZAt(*later, 0, 10, 12) + invZAt(*later, 0, 18, 12), kNear + kFar, kInvZError);
}

// Depth that is a px wider than what it is the depth of, and colour with noise, as estimated depth
// and cameras have it. Nothing says what is behind.
TEST_F(FrameRetimerTest, addsNoNoiseWhereNothingIsKnownBehindAnEdge) {
  constexpr int kLeast = 56, kMost = 204;  // codes of the frame
  constexpr int kBeyond = 20;              // codes: what light is carried on by to an edge
  const auto noisy = [](uint32_t x, uint32_t y) {
    MovingPx px = plateAt(x, y);
    const uint32_t noise = (x * 2654435761U ^ y * 2246822519U) >> 28;  // 0..15
    const bool is_light = isPlate(x, y) && isPlate(x + 1, y);
    px.color = glm::u8vec3(uint8_t(is_light ? kMost - noise : kLeast + noise));
    return px;
  };
  const FramePtr frame = movingFrame({noisy}, kTolerance);
  for (int step = 0; step < 16; ++step) {
    const FramePtr later = retimed(frame, (3 + step / 16.0) * kPxTime_s);
    for (uint32_t i = 0; i < kMovedPx.area(); ++i) {
      const glm::u8vec3 color = colorAt(*later, 0, i % kMovedPx.width, i / kMovedPx.width);
      if (invZAt(*later, 0, i % kMovedPx.width, i / kMovedPx.width) < 0) continue;
      ASSERT_GE(color.g, kLeast - kBeyond) << "px " << i << ", step " << step;
      ASSERT_LE(color.g, kMost + kBeyond) << "px " << i << ", step " << step;
    }
  }
}

// The plate's shares of antialiased pixels: of the wall's pixel right of its right edge, and of
// its own pixel at its left edge.
constexpr float kShareBeside = 0.3F, kShareOfOwn = 0.6F;

MovingPx smoothPlateAt(uint32_t x, uint32_t y) {
  MovingPx px = plateAt(x, y);
  if (y < 8 || y >= 16) return px;
  const MovingPx plate{.color = colorOfPx(x, y, 200)};
  if (x == 18) px.color = mixOf(plate, wallAt(x, y), kShareBeside);
  if (x == 10) px.color = mixOf(plate, wallAt(x, y), kShareOfOwn);
  return px;
}

TEST_F(FrameRetimerTest, takesTheLightOfEdgesApartAndPutsItTogetherWhereTheyHaveGone) {
  for (const bool has_layer_behind : {true, false}) {
    std::vector<MovingLayer> layers{smoothPlateAt};
    if (has_layer_behind) layers.push_back(behindPlateAt);
    for (const int gone_px : {-4, 3}) {
      SCOPED_TRACE(testing::Message() << gone_px << ", " << has_layer_behind);
      const FramePtr later = retimed(movingFrame(layers, kTolerance), gone_px * kPxTime_s);
      const auto plateOf = [](uint32_t x) { return MovingPx{.color = colorOfPx(x, 12, 200)}; };
      const auto wasAt = [&](uint32_t x) { return uint32_t(int(x) + gone_px); };
      // An unknown background is assumed to equal its neighbour.
      const uint32_t right = !has_layer_behind && gone_px < 0 ? 18 : wasAt(18);
      expectNear(colorAt(*later, 0, wasAt(18), 12),
                 mixOf(plateOf(18), wallAt(right, 12), kShareBeside));
      if (has_layer_behind) {
        expectNear(colorAt(*later, 0, wasAt(10), 12),
                   mixOf(plateOf(10), wallAt(wasAt(10), 12), kShareOfOwn));
      }
      // The plate leaves no trace in its old place.
      if (gone_px < 0) expectNear(colorAt(*later, 0, 18, 12), wallAt(18, 12).color);
      expectNear(colorAt(*later, 0, gone_px < 0 ? 19 : 9, 12),
                 wallAt(gone_px < 0 ? 19 : 9, 12).color);
    }
  }
}

TEST_F(FrameRetimerTest, leavesEdgesOfWhatIsBeforeItAlone) {
  // The wall moves and the plate stands. Its edges stay, over another part of the wall.
  const auto front = [](uint32_t x, uint32_t y) {
    MovingPx px = smoothPlateAt(x, y);
    px.motion_mps = isPlate(x, y) ? glm::vec3(0) : glm::vec3(1, 0, 0);
    return px;
  };
  const auto behind = [](uint32_t x, uint32_t y) {
    MovingPx px = behindPlateAt(x, y);
    if (px.inv_z >= 0) px.motion_mps = {1, 0, 0};
    return px;
  };
  constexpr uint32_t kGone_px = 2;
  const FramePtr later =
      retimed(movingFrame({front, behind}, kTolerance), kGone_px * 2 * kPxTime_s);
  EXPECT_EQ(colorAt(*later, 0, 14, 12), plateAt(14, 12).color);
  expectNear(colorAt(*later, 0, 18, 12), mixOf(MovingPx{.color = colorOfPx(18, 12, 200)},
                                               wallAt(18 - kGone_px, 12), kShareBeside));
  expectNear(colorAt(*later, 0, 20, 12), wallAt(18, 12).color);
}

TEST_F(FrameRetimerTest, tearsWhatOnlyTouched) {
  // Two halves of one depth, side by side. The right half moves up by 6 px.
  const auto layer = [](uint32_t x, uint32_t y) {
    MovingPx px = wallAt(x, y);
    px.inv_z = kNear;
    if (x >= 16) px.motion_mps = {0, 1, 0};
    return px;
  };
  const FramePtr later = retimed(movingFrame({layer}, kTolerance), 6 * kPxTime_s);
  EXPECT_EQ(colorAt(*later, 0, 15, 10), wallAt(15, 10).color);
  EXPECT_EQ(colorAt(*later, 0, 16, 10), wallAt(16, 16).color);
}

TEST_F(FrameRetimerTest, readsMotionAlongTheAxesOfTheWorld) {
  const Pose pose{.position_m = {5, -1, 2},
                  .orientation = glm::angleAxis(1.1, glm::normalize(glm::dvec3(1, 2, 3)))};
  const glm::vec3 in_camera_mps(0.5F, -0.25F, 0.75F);
  const auto moving = [](const glm::vec3& motion_mps) {
    return [motion_mps](uint32_t x, uint32_t y) { return wallAt(x, y, motion_mps); };
  };
  const auto in_world_mps = glm::vec3(pose.orientation * glm::dvec3(in_camera_mps));
  const FramePtr straight = retimed(movingFrame({moving(in_camera_mps)}, kTolerance), 0.5);
  const FramePtr turned = retimed(movingFrame({moving(in_world_mps)}, kTolerance, pose), 0.5);
  // Speeds are binary16, to within 2^-11: over half a second 0.2 mm of 4 m.
  for (uint32_t y = 2; y < kMovedPx.height - 2; ++y) {
    for (uint32_t x = 2; x < kMovedPx.width - 2; ++x) {
      EXPECT_NEAR(invZAt(*turned, 0, x, y), invZAt(*straight, 0, x, y), 2e-5);
    }
  }
}

TEST_F(FrameRetimerTest, forgetsWhatHasPassedTheCamera) {
  const FramePtr later = retimed(movingFrame({[](uint32_t x, uint32_t y) {
                                               return wallAt(x, y, {0, 0, 5});
                                             }},
                                             kTolerance),
                                 1);
  for (uint32_t x = 0; x < kMovedPx.width; ++x) EXPECT_LT(invZAt(*later, 0, x, 12), 0);
}

// All of it mirrors.
FramePtr mirroringFrame(const std::vector<MovingLayer>& layers) {
  auto frame = std::make_shared<Frame>(*movingFrame(layers, kTolerance));
  for (LayerPlanes& layer : frame->sources.front()) {
    layer.surface = std::make_shared<const std::vector<uint8_t>>(
        kMovedPx.area() * kSurfaceTexelBytes, uint8_t{9});
  }
  return frame;
}

std::vector<SharedBytes> planesOf(const Frame& frame) {
  std::vector<SharedBytes> planes;
  for (const LayerPlanes& layer : frame.sources.front()) {
    planes.insert(planes.end(), {layer.depth, layer.color, layer.surface});
  }
  return planes;
}

TEST_F(FrameRetimerTest, leavesNothingOfFramesInWhoseMemoryItWrites) {
  const auto holed = [](uint32_t x, uint32_t y) {
    return x < 5 || y % 7 == 3 ? MovingPx{} : plateAt(x, y);
  };
  const std::vector<FramePtr> frames{mirroringFrame({plateAt, plateAt}),
                                     mirroringFrame({holed, behindPlateAt}),
                                     movingFrame({holed, holed}, kTolerance)};
  FrameRetimer retimer(workers_);
  for (const FramePtr& frame : frames) {
    for (const double gone_px : {-30.0, 2.5, 40.0}) {
      const FramePtr anew = retimed(frame, gone_px * kPxTime_s);
      const FramePtr again = retimer.retime(frame, gone_px * kPxTime_s);
      const auto isSame = [](const SharedBytes& a, const SharedBytes& b) {
        return a == b || *a == *b;
      };
      EXPECT_TRUE(std::ranges::equal(planesOf(*anew), planesOf(*again), isSame));
    }
  }
}

TEST_F(FrameRetimerTest, sharesThePlanesOfSourcesThatStand) {
  auto frame = std::make_shared<Frame>(*movingFrame({plateAt}, kTolerance));
  const FramePtr still =
      movingFrame({[](uint32_t x, uint32_t y) { return wallAt(x, y); }}, kTolerance);
  frame->format.sources.insert(frame->format.sources.begin(), still->format.sources[0]);
  frame->sources.insert(frame->sources.begin(), still->sources[0]);
  const FramePtr later = retimed(frame, kPxTime_s);
  EXPECT_EQ(later->sources[0][0].depth, still->sources[0][0].depth);
  EXPECT_NE(*later->sources[1][0].color, *frame->sources[1][0].color);
}

}  // namespace
}  // namespace viewloom::test::frame_retimer_test
