// SPDX-License-Identifier: Apache-2.0
#include "e2e/bystander.h"

#include <gtest/gtest.h>

namespace viewloom {

Bystander::Bystander(TestServer& server)
    : publisher_(server.connect(), "healthy"), watcher_(server.connect(), smallQuilt("healthy")) {
  // The first frame may come before the display: only from the next on both know of each other.
  EXPECT_TRUE(publisher_.sendFrame(++number_));
  EXPECT_TRUE(publisher_.readReport().has_value());
  EXPECT_TRUE(watcher_.readAtlas().has_value());
}

void Bystander::expectUndisturbed() {
  ++number_;
  EXPECT_TRUE(publisher_.sendFrame(number_));
  const auto atlas = watcher_.readAtlas();
  ASSERT_TRUE(atlas.has_value()) << "the bystander's display has ended";
  EXPECT_EQ(atlas->header.sequence(), number_);
  EXPECT_EQ(atlas->header.frame_number(), number_);
  EXPECT_EQ(atlas->skipped_count, 0u);
  const auto report = publisher_.readReport();
  ASSERT_TRUE(report.has_value()) << "the bystander's publisher has ended";
  EXPECT_EQ(report->outcome(), v1::FRAME_OUTCOME_TRACED);
}

}  // namespace viewloom
