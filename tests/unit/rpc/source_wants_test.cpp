// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "rpc/source_wants.h"

namespace viewloom::source_wants_test {
namespace {

// A view half a metre to the right of the source, 45 degrees to each side.
std::shared_ptr<const AtlasLayout> viewBeside() {
  auto layout = std::make_shared<AtlasLayout>();
  layout->tile_size_px = {10, 10};
  layout->views.resize(1);
  layout->views[0].camera = {.pose = {.position_m = {0.5, 0, 0}},
                             .intrinsics = {.focal_px = {5, 5}, .principal_px = {5, 5}}};
  return layout;
}

std::shared_ptr<EncodedAtlas> atlasOutside(uint64_t display_id,
                                           const std::shared_ptr<const AtlasLayout>& layout,
                                           std::vector<double> shares) {
  auto atlas = std::make_shared<EncodedAtlas>();
  atlas->display_id = display_id;
  atlas->layout = layout;
  atlas->outside_shares = std::move(shares);
  return atlas;
}

TEST(SourceWants, tellsByDisplayOfViewsThatLookPast) {
  const std::shared_ptr<const AtlasLayout> layout = viewBeside();
  const std::vector<AtlasPtr> atlases{atlasOutside(4, layout, {0.031, -0.1, 0.2}),
                                      atlasOutside(7, layout, {-0.1, 0})};
  SourceWants wants;
  const v1::Wanted wanted = wants.wanted(atlases, 2);
  ASSERT_EQ(wanted.outside_size(), 1) << "the other sees enough";
  EXPECT_EQ(wanted.outside(0).display_id(), 4U);
  ASSERT_EQ(wanted.outside(0).views_size(), 2);
  EXPECT_EQ(wanted.outside(0).views(0).last_view(), 0U);
  EXPECT_DOUBLE_EQ(wanted.outside(0).views(0).share(), 0.04);
  EXPECT_EQ(wanted.outside(0).views(1).first_view(), 2U);
}

TEST(SourceWants, saysLittleWhileDepthTrembles) {
  std::mt19937 random(11);
  std::normal_distribution<double> tremble(0, 0.001);
  const std::shared_ptr<const AtlasLayout> layout = viewBeside();
  SourceWants wants;
  std::string before;
  size_t messages = 0;
  for (int frame = 0; frame < 1000; ++frame) {
    std::vector<double> shares{0.04, 0.03, 0.01, 0.0, -0.01};
    for (double& share : shares) share += tremble(random);
    auto atlas = atlasOutside(1, layout, shares);
    atlas->stats.inv_z_near = 2 + tremble(random);
    atlas->stats.inv_z_far = 0.5 + tremble(random);
    const v1::Wanted wanted = wants.wanted(std::vector<AtlasPtr>{atlas}, 1);
    messages += wanted.SerializeAsString() != before;
    before = wanted.SerializeAsString();
  }
  EXPECT_LE(messages, 6U);
}

TEST(SourceWants, settlesAnewForAnotherLayout) {
  const std::shared_ptr<const AtlasLayout> layout = viewBeside(), other = viewBeside();
  SourceWants wants;
  const auto shareOf = [&](const std::shared_ptr<const AtlasLayout>& seen, double share) {
    const std::vector<AtlasPtr> atlases{atlasOutside(1, seen, {share})};
    return wants.wanted(atlases, 1).outside(0).views(0).share();
  };
  EXPECT_DOUBLE_EQ(shareOf(layout, 0.031), 0.04);
  EXPECT_DOUBLE_EQ(shareOf(layout, 0.029), 0.04);
  EXPECT_DOUBLE_EQ(shareOf(other, 0.029), 0.03);
}

TEST(SourceWants, sizesTheFieldByTheDepthsInUse) {
  const std::shared_ptr<const AtlasLayout> layout = viewBeside();
  SourceWants wants;
  const auto rightOf = [&](double inv_z_near) {
    auto atlas = atlasOutside(1, layout, {});
    atlas->stats.inv_z_near = inv_z_near;
    return std::tan(wants.wanted(std::vector<AtlasPtr>{atlas}, 1).fov().angle_right_rad());
  };
  EXPECT_NEAR(rightOf(2), 1 + 0.5 * 2 * 17 / 16, 1e-12);
  EXPECT_EQ(rightOf(2.1), rightOf(2)) << "it was a 16th wider";
  EXPECT_NEAR(rightOf(3), 1 + 0.5 * 3 * 17 / 16, 1e-12);
  EXPECT_NEAR(rightOf(1), 1 + 0.5 * 1 * 17 / 16, 1e-12);
}

}  // namespace
}  // namespace viewloom::source_wants_test
