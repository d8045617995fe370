// SPDX-License-Identifier: Apache-2.0
#include "oracle/oracle_source.h"

#include <gtest/gtest.h>

#include <cmath>

namespace viewloom::oracle::oracle_source_test {
namespace {

OracleSource rowOf(std::vector<float> inv_z, ConnectionTolerance kappa = {0.01f, 0}) {
  InvZPlanes planes = makePlanes(int(inv_z.size()), 1, 1);
  planes.inv_z = std::move(inv_z);
  return OracleSource(std::move(planes), {}, kappa);
}

// Two columns of two layers each.
OracleSource pairOfColumns(float left_0, float left_1, float right_0, float right_1) {
  InvZPlanes planes = makePlanes(2, 1, 2);
  planes.at(0, 0, 0) = left_0;
  planes.at(1, 0, 0) = left_1;
  planes.at(0, 1, 0) = right_0;
  planes.at(1, 1, 0) = right_1;
  return OracleSource(std::move(planes), {}, {0.01f, 0});
}

TEST(CanonicalPlanes, sortsDropsDoublesAndClosesGaps) {
  InvZPlanes planes = makePlanes(1, 1, 4);
  planes.inv_z = {0.5f, kNoSurface, 1.0f, 0.995f};
  EXPECT_EQ(canonicalPlanes(planes, 0.01f).inv_z,
            (std::vector<float>{1.0f, 0.5f, kNoSurface, kNoSurface}));
}

TEST(RoundSlope, keepsEightSignificantBits) {
  EXPECT_EQ(roundSlope(255.0f), 255.0f);
  EXPECT_EQ(roundSlope(256.0f + 1.0f), 258.0f);  // a tie: away from zero
  EXPECT_EQ(roundSlope(-257.0f), -258.0f);
  EXPECT_EQ(roundSlope(256.9f), 256.0f);
  EXPECT_EQ(roundSlope(std::ldexp(1.0f, -100)), std::ldexp(1.0f, -100));
  EXPECT_EQ(roundSlope(std::ldexp(1.9f, -101)), 0.0f);
}

TEST(OracleSource, slopesAreTheSmallerOneSidedDifference) {
  const OracleSource source = rowOf({1.0f, 1.25f, 2.0f, 1.5f});
  EXPECT_EQ(source.facet({0, 1, 0}).slope_x, 0.25f);
  EXPECT_EQ(source.facet({0, 2, 0}).slope_x, 0.0f);  // a peak
}

TEST(OracleSource, atABorderTheNextDifferenceDecidesToo) {
  const OracleSource source = rowOf({1.0f, 1.25f, 1.75f, 1.5f});
  EXPECT_EQ(source.facet({0, 0, 0}).slope_x, 0.25f);
  EXPECT_EQ(source.facet({0, 3, 0}).slope_x, 0.0f);
  EXPECT_EQ(rowOf({1.0f, 1.25f}).facet({0, 0, 0}).slope_x, 0.0f);  // nothing further on
  EXPECT_EQ(rowOf({1.0f, 1.25f, kNoSurface}).facet({0, 1, 0}).slope_x, 0.0f);
}

TEST(OracleSource, slopesFollowTheNearestSurfaceAcrossLayers) {
  InvZPlanes planes = makePlanes(3, 1, 2);
  planes.inv_z = {0.5f,       2.0f,   0.75f,        // layer 0: background, pole, background
                  kNoSurface, 0.625f, kNoSurface};  // layer 1: the background behind the pole
  const OracleSource source(planes, {}, {0.01f, 0});
  EXPECT_EQ(source.facet({1, 1, 0}).slope_x, 0.125f);
  EXPECT_EQ(source.facet({0, 0, 0}).slope_x, 0.125f);
  EXPECT_EQ(source.facet({0, 1, 0}).slope_x, 0.0f);  // the pole does not lean
}

TEST(OracleSource, slantedPlanesStayConnected) {
  const OracleSource source = rowOf({1.0f, 1.5f, 2.0f, 2.5f});
  EXPECT_TRUE(source.linked({0, 1, 0}, {0, 2, 0}));
  EXPECT_TRUE(source.linked({0, 2, 0}, {0, 1, 0}));
}

TEST(OracleSource, stepsAboveKappaAreSilhouettes) {
  EXPECT_FALSE(rowOf({1.0f, 1.5f}).linked({0, 0, 0}, {0, 1, 0}));
  EXPECT_TRUE(rowOf({1.0f, 1.5f}, {0, 0.4f}).linked({0, 0, 0}, {0, 1, 0}));
}

TEST(OracleSource, aBackgroundIsOneSurfaceBesideAndBehindASilhouette) {
  const OracleSource source = pairOfColumns(0.5f, kNoSurface, 2.0f, 0.505f);
  EXPECT_TRUE(source.linked({0, 0, 0}, {1, 1, 0}));
  EXPECT_TRUE(source.linked({1, 1, 0}, {0, 0, 0}));
  EXPECT_FALSE(source.linked({0, 0, 0}, {0, 1, 0}));
}

TEST(OracleSource, aLinkWithinALayerComesFirst) {
  const OracleSource source = pairOfColumns(0.5f, kNoSurface, 0.507f, 0.5f);
  EXPECT_TRUE(source.linked({0, 0, 0}, {0, 1, 0}));
  EXPECT_FALSE(source.linked({0, 0, 0}, {1, 1, 0}));
}

TEST(OracleSource, acrossLayersEachMustBeTheOthersNearest) {
  const OracleSource source = pairOfColumns(0.52f, 0.505f, 2.0f, 0.512f);
  EXPECT_TRUE(source.linked({1, 0, 0}, {1, 1, 0}));  // within the layer, though 0 is about as near
  EXPECT_FALSE(source.linked({0, 0, 0}, {1, 1, 0}));
}

}  // namespace
}  // namespace viewloom::oracle::oracle_source_test
