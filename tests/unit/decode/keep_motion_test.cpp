// SPDX-License-Identifier: Apache-2.0
#include "decode/keep_motion.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <memory>

namespace viewloom::keep_motion_test {
namespace {

constexpr uint16_t kOne = 0x3c00;
constexpr uint16_t kMinusZero = 0x8000;
constexpr uint16_t kInfinity = 0xfc00;
constexpr uint16_t kNan = 0x7e01;

SharedBytes planeOf(std::initializer_list<uint16_t> halves) {
  std::vector<uint8_t> bytes;
  for (const uint16_t half : halves) {
    bytes.push_back(uint8_t(half));
    bytes.push_back(uint8_t(half >> 8));
  }
  return std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
}

LayerPlanes kept(const SharedBytes& plane) {
  BytePool pool(2);
  LayerPlanes planes;
  keepMotion(plane, pool, planes);
  return planes;
}

TEST(KeepMotion, handsFiniteMotionOnWithoutACopy) {
  const SharedBytes plane = planeOf({0, 0, 0, kOne, 0, 0});
  const LayerPlanes planes = kept(plane);
  EXPECT_EQ(planes.motion, plane);
  EXPECT_EQ(planes.bad_motions_count, 0u);
}

TEST(KeepMotion, dropsPlanesInWhichNothingMoves) {
  EXPECT_EQ(kept(planeOf({0, kMinusZero, 0, 0, 0, 0})).motion, nullptr);
  const LayerPlanes bad = kept(planeOf({kNan, kOne, 0, 0, 0, 0}));
  EXPECT_EQ(bad.motion, nullptr);
  EXPECT_EQ(bad.bad_motions_count, 1u);
}

TEST(KeepMotion, letsStandWhatIsNoFiniteNumberAndCountsIt) {
  const LayerPlanes planes =
      kept(planeOf({kOne, kNan, kOne, kOne, kOne, kOne, 0, 0, kInfinity, kOne, 0, 0}));
  ASSERT_NE(planes.motion, nullptr);
  EXPECT_EQ(*planes.motion, *planeOf({0, 0, 0, kOne, kOne, kOne, 0, 0, 0, kOne, 0, 0}));
  EXPECT_EQ(planes.bad_motions_count, 2u);
}

}  // namespace
}  // namespace viewloom::keep_motion_test
