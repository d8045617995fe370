// SPDX-License-Identifier: Apache-2.0
#include "base/cost_estimate.h"

#include <gtest/gtest.h>

namespace viewloom::cost_estimate_test {
namespace {

TEST(CostEstimate, learnsFromMeasurementsAndRisesFasterThanItFalls) {
  CostEstimate estimate(100);
  EXPECT_EQ(estimate.predictNs(10), 1000);
  EXPECT_EQ(estimate.unitsFor(1000), 10U);
  for (int i = 0; i < 30; ++i) estimate.note(10, 5000);
  EXPECT_NEAR(estimate.nsPerUnit(), 500, 5);
  estimate.note(10, 10000);
  const double risen = estimate.nsPerUnit() - 500;
  EXPECT_NEAR(risen, 250, 10);
  estimate.note(10, 0);
  EXPECT_NEAR(estimate.nsPerUnit(), 750, 10) << "nothing was measured";
  EXPECT_EQ(CostEstimate(1e12).unitsFor(kPiece_ns), 1U) << "one unit is the least";
}

}  // namespace
}  // namespace viewloom::cost_estimate_test
