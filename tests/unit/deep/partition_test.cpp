// SPDX-License-Identifier: Apache-2.0
#include "deep/split_pixel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace viewloom::deep::partition_test {
namespace {

DeepPoint surface(double inv_z, double alpha) {
  return {.inv_z = inv_z, .alpha = alpha, .color = glm::dvec3(alpha)};
}

// The error of groups that end at `ends`, by its definition.
double errorOf(const std::vector<DeepPoint>& points, const std::vector<size_t>& ends) {
  double error = 0;
  double transmittance = 1;
  size_t begin = 0;
  for (const size_t end : ends) {
    const double inv_z = joined(std::span(points).subspan(begin, end - begin)).inv_z;
    for (size_t i = begin; i < end; ++i) {
      const double weight = presence(points[i]) * std::max(transmittance, 1.0 / 16);
      error += weight * std::abs(points[i].inv_z - inv_z);
      transmittance *= 1 - points[i].alpha;
    }
    begin = end;
  }
  return error;
}

// The least over all ways to cut, each tried.
double leastError(const std::vector<DeepPoint>& points, uint32_t group_count_max) {
  double least = std::numeric_limits<double>::infinity();
  std::vector<size_t> ends;
  const std::function<void(size_t)> cutFrom = [&](size_t begin) {
    if (begin == points.size()) least = std::min(least, errorOf(points, ends));
    if (ends.size() == group_count_max) return;
    for (size_t end = begin + 1; end <= points.size(); ++end) {
      ends.push_back(end);
      cutFrom(end);
      ends.pop_back();
    }
  };
  cutFrom(0);
  return least;
}

TEST(Partition, keepsTwoClosePairsApart) {
  const std::vector<DeepPoint> points = {surface(1, 0.5), surface(0.9, 0.5), surface(0.2, 0.5),
                                         surface(0.1, 1)};
  const Partition partition = partitionPoints(points, 2);
  ASSERT_EQ(partition.group_count, 2U);
  EXPECT_EQ(partition.ends[0], 2U);
  EXPECT_EQ(partition.ends[1], 4U);
  // Contributions 1/2 and 1/4 of the front pair: 1/Z = (0.5 + 0.225) / 0.75, 1/30 and 2/30 off.
  // Of the back one 1/8 and 1/8: 0.05 off, each.
  EXPECT_NEAR(partition.error_per_m, 0.5 / 30 + 0.25 * 2 / 30 + 2 * 0.125 * 0.05, 1e-12);
}

TEST(Partition, costsNothingWithAsManyGroupsAsPoints) {
  const std::vector<DeepPoint> points = {surface(1, 0.5), surface(0.5, 0.5), surface(0, 1)};
  const Partition partition = partitionPoints(points, 4);
  EXPECT_EQ(partition.group_count, 3U);
  EXPECT_EQ(partition.error_per_m, 0);
}

TEST(Partition, givesHazeUpBeforeAHiddenSurface) {
  // 1 % of haze, a wall, and a wall behind it that other views see.
  const std::vector<DeepPoint> points = {surface(1, 0.01), surface(0.5, 1), surface(0.25, 1)};
  const Partition partition = partitionPoints(points, 2);
  EXPECT_EQ(partition.ends[0], 2U);
  EXPECT_NEAR(joined(std::span(points).first(2)).inv_z, 0.01 + 0.99 * 0.5, 1e-12);
}

TEST(Partition, leavesAVisibleSurfaceWhereItIsWhateverIsHiddenBehindIt) {
  const std::vector<DeepPoint> points = {surface(0.5, 1), surface(0.25, 1)};
  const Partition partition = partitionPoints(points, 1);
  EXPECT_EQ(joined(points).inv_z, 0.5);
  EXPECT_NEAR(partition.error_per_m, 0.25 / 16, 1e-12);
}

TEST(Partition, placesLightWithoutAlphaByItsLight) {
  const std::vector<DeepPoint> fire = {{.inv_z = 1, .alpha = 0, .color = {0.2, 0.1, 0}},
                                       {.inv_z = 0.5, .alpha = 0, .color = {0, 0.6, 0}}};
  const DeepPoint all = joined(fire);
  EXPECT_NEAR(all.inv_z, (0.2 + 0.6 * 0.5) / 0.8, 1e-12);
  EXPECT_EQ(all.alpha, 0);
  EXPECT_EQ(all.color, glm::dvec3(0.2, 0.1 + 0.6, 0));
}

TEST(Partition, isTheBestOfAll) {
  const unsigned seed = 4711;
  std::mt19937 random(seed);
  const auto chance = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  for (int round = 0; round < 3000; ++round) {
    std::vector<DeepPoint> points(1 + random() % 9);
    for (DeepPoint& point : points) {
      point = {.inv_z = random() % 8 == 0 ? 0 : chance(),
               .alpha = random() % 6 == 0   ? 1
                        : random() % 6 == 0 ? 0
                                            : chance() * chance(),
               .color = {chance(), chance() * 3, chance()}};
    }
    std::sort(points.begin(), points.end(),
              [](const DeepPoint& a, const DeepPoint& b) { return a.inv_z > b.inv_z; });
    const auto groups = static_cast<uint32_t>(1 + random() % 4);
    const Partition partition = partitionPoints(points, groups);
    const std::vector<size_t> ends(partition.ends.begin(),
                                   partition.ends.begin() + partition.group_count);
    ASSERT_EQ(ends.back(), points.size());
    // Both sum nine numbers of size one in binary64, in another order.
    ASSERT_NEAR(partition.error_per_m, errorOf(points, ends), 1e-13) << seed << ", " << round;
    ASSERT_NEAR(partition.error_per_m, leastError(points, groups), 1e-13) << seed << ", " << round;
  }
}

}  // namespace
}  // namespace viewloom::deep::partition_test
